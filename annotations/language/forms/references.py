"""What ``it`` and ``them`` stand for: the last thing, or the last person, that a form described before."""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.forms.terms import (
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    children,
    walk,
)

# A λ of which one of these is said describes a person.
PERSON_PREDICATES = frozenset(("person", "name", "male", "female", "gesture", "pose", "gender"))
PERSON, THING = "person", "thing"


def antecedent_kinds(word: str) -> tuple[str, ...]:
    """Return what a reference may stand for, the likeliest first: ``them`` is a person, or else several things."""
    return (PERSON, THING) if word == "them" else (THING,)


def described_kind(form: Form) -> str:
    """Return whether an argument describes a person or a thing; empty where it describes neither."""
    if isinstance(form, Lambda):
        said = {node.predicate for node in walk(form) if isinstance(node, Application)}
        return PERSON if said & PERSON_PREDICATES else THING
    if isinstance(form, Constant):
        return {"name": PERSON, "object": THING, "category": THING}.get(form.token_class, "")
    return ""


def loose_references(form: Form) -> tuple[str, ...]:
    """Return the references of a form with class tokens before which it describes nothing they can stand for.

    A text that is no class token may name anything.
    """
    seen: set[str] = set()
    loose = []
    for node in _in_order(form):
        if isinstance(node, Reference):
            if seen.isdisjoint(antecedent_kinds(node.word)):
                loose.append(node.word)
        elif isinstance(node, Constant) and not node.token_class:
            seen |= {PERSON, THING}
        else:
            seen.add(described_kind(node))
    return tuple(dict.fromkeys(loose))


def _in_order(form: Form) -> Iterator[Form]:
    """Yield the parts of a form in the order in which they are understood: what is inside a description first."""
    for child in children(form):
        yield from _in_order(child)
    yield form
