"""Hypothesis strategies for closed logical forms, and ways to rename their variables."""

from __future__ import annotations

from hypothesis import strategies as st

from annotations.language.forms import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Nonterminal,
    Reference,
    Variable,
    Wildcard,
)

PREDICATES = st.sampled_from(["bring", "and", "is_a", "left_of", "x", "lambdas", "UNKNOWNS", "y-z"])
TEXTS = st.one_of(
    st.sampled_from(["<object>", "<name1>", "3", "$1", "UNKNOWN", "a (b)", "tea  spoon", "{room}"]),
    st.text(st.characters(blacklist_categories=["Cs", "Cc", "Zl", "Zp"]), min_size=1),
).filter(lambda text: bool(text.split()))
SLOTS = st.sampled_from(
    [
        Nonterminal("oprop"),
        Wildcard("room"),
        Wildcard("object", "known", 2, obfuscated=True),
        Wildcard("pron", "sub"),
    ]
)
LEAVES = st.one_of(
    st.builds(Constant, TEXTS),
    st.builds(Constant, st.integers()),
    SLOTS,
    st.just(UNKNOWN),
    st.sampled_from([Reference("it"), Reference("them")]),
)


@st.composite
def inner(draw: st.DrawFn, bound: tuple[int, ...], levels: int) -> Form:
    leaves = LEAVES
    if bound:
        leaves = st.one_of(st.builds(Variable, st.sampled_from(bound)), LEAVES)
    shape = draw(st.sampled_from(["leaf", "application", "λ"] if levels else ["leaf"]))
    return draw(leaves if shape == "leaf" else composite(shape, bound, levels))


@st.composite
def composite(draw: st.DrawFn, shape: str, bound: tuple[int, ...], levels: int) -> Form:
    if shape == "λ":
        variable = draw(st.integers(min_value=0, max_value=5))
        bodies = draw(st.lists(inner((*bound, variable), levels - 1), min_size=1, max_size=3))
        return Lambda(variable, draw(st.sampled_from(["e", "t"])), tuple(bodies))
    predicate = draw(st.one_of(PREDICATES, st.just(Nonterminal("oprop"))))
    return Application(predicate, tuple(draw(st.lists(inner(bound, levels - 1), max_size=3))))


@st.composite
def forms(draw: st.DrawFn) -> Form:
    """A form that could stand on its own: closed, with a λ or an application at the top."""
    shape = draw(st.sampled_from(["application", "λ", "UNKNOWN"]))
    return UNKNOWN if shape == "UNKNOWN" else draw(composite(shape, (), 4))


def renamed(form: Form, shift: int, scope: dict[int, int] | None = None, level: int = 0) -> Form:
    """The same form under other variable names, no two of which are equal on a path."""
    scope = scope or {}
    if isinstance(form, Variable):
        return Variable(scope[form.index])
    if isinstance(form, Lambda):
        name = 7 * (level + 1) + shift
        inside = {**scope, form.variable: name}
        return Lambda(
            name,
            form.type,
            tuple(renamed(body, shift, inside, level + 1) for body in form.bodies),
        )
    if isinstance(form, Application):
        arguments = (renamed(argument, shift, scope, level) for argument in form.arguments)
        return Application(form.predicate, tuple(arguments))
    return form
