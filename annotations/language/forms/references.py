"""What ``it`` and ``them`` stand for: the last thing, or the last person, that a form described before."""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.forms.meanings import (
    NOUN,
    PERSON,
    PERSON_PREDICATES,
    PLACE_CLASSES,
    THING,
    THINGS,
    kind_of_class,
)
from annotations.language.forms.symbols import Wildcard
from annotations.language.forms.terms import (
    CONJUNCTION,
    SEQUENCE,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Variable,
    children,
)

# What a word can stand for, the likeliest first.
ANTECEDENTS = {"it": (THING, THINGS), "them": (PERSON, THINGS)}


def described_kind(form: Form) -> str:
    """Return whether an argument describes a person, a thing or several; empty where it describes nothing.

    Several things are those of a category.
    """
    if isinstance(form, Constant):
        return kind_of_class(form.token_class)
    if isinstance(form, Wildcard):
        return kind_of_class(form.entity_class)
    if not isinstance(form, Lambda):
        return ""
    said = list(_said_of(form, form.variable))
    if any(each.predicate in PERSON_PREDICATES for each in said):
        return PERSON
    kinds = [described_kind(each.arguments[1]) for each in said if len(each.arguments) > 1]
    tokens = (each for each in kinds if each)
    is_place = any(
        isinstance(argument, Constant) and argument.token_class in PLACE_CLASSES
        for each in said
        if each.predicate == NOUN
        for argument in each.arguments
    )
    return "" if is_place else (THINGS if next(tokens, "") == THINGS else THING)


def loose_references(form: Form) -> tuple[str, ...]:
    """Return the references of a form with class tokens before which it describes nothing they can stand for.

    A text that is no class token may name anything.
    """
    seen: set[str] = set()
    loose = []
    for action in _actions(form):
        described: set[str] = set()
        for node in _in_order(action):
            if isinstance(node, Reference):
                if seen.isdisjoint(ANTECEDENTS[node.word]):
                    loose.append(node.word)
            elif isinstance(node, Constant) and not node.token_class:
                described |= {PERSON, THING, THINGS}
            else:
                described.add(described_kind(node))
        seen |= described
    return tuple(dict.fromkeys(loose))


def _said_of(form: Form, variable: int) -> Iterator[Application]:
    """Yield what a λ says of its own variable, not what it says of others inside."""
    for each in children(form):
        if isinstance(each, Lambda) or (
            isinstance(each, Application) and each.predicate == CONJUNCTION
        ):
            yield from _said_of(each, variable)
        elif isinstance(each, Application) and each.arguments[:1] == (Variable(variable),):
            yield each


def _actions(form: Form) -> Iterator[Form]:
    """Yield the actions of a sequence, or the form: what an action describes, only a later one can refer to."""
    if isinstance(form, Application) and form.predicate == SEQUENCE:
        for each in form.arguments:
            yield from _actions(each)
    else:
        yield form


def _in_order(form: Form) -> Iterator[Form]:
    """Yield the parts of a form in the order in which they are understood: what is inside a description first."""
    for child in children(form):
        yield from _in_order(child)
    yield form
