"""The contexts in which parts of forms occur: closure keeps to those that it has seen."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeGuard

from annotations.language.forms import (
    Application,
    Form,
    Lambda,
    Variable,
    children,
    predicates,
    walk,
)

Rebuild = Callable[[Form], Form]
Leaf = Application


@dataclass(frozen=True, slots=True)
class Place:
    """A part of a form; ``rebuild`` returns the form with something else in its place.

    ``holder`` is the application that has it as an argument, with the argument's number.
    """

    part: Form
    rebuild: Rebuild
    holder: tuple[str, int] | None = None


@dataclass(frozen=True, slots=True)
class Contexts:
    """The contexts seen in a set of forms."""

    leaves: tuple[Leaf, ...]  # descriptions, as ``at($1, <room>)``
    beside: frozenset[tuple[str, str]]  # predicates in one conjunction
    inside: frozenset[tuple[str, int, str]]  # action, argument, predicate anywhere in it
    terms: tuple[Lambda, ...]  # the λs that are arguments

    def go_together(self, leaf: Leaf, others: Iterable[Form]) -> bool:
        """Return whether ``leaf`` has another predicate than each of ``others`` and was seen beside each of them."""
        names = [each.predicate for each in others if isinstance(each, Application)]
        mine = leaf.predicate
        return all(name != mine and (mine, name) in self.beside for name in names)

    def may_hold(self, holder: tuple[str, int], term: Lambda) -> bool:
        """Return whether every predicate in ``term`` was seen in that argument."""
        return all((*holder, name) in self.inside for name in predicates(term))


def find_contexts(forms: Sequence[Form]) -> Contexts:
    """Collect the contexts of all parts of ``forms``."""
    leaves: dict[Leaf, None] = {}
    beside: set[tuple[str, str]] = set()
    inside: set[tuple[str, int, str]] = set()
    terms: dict[Lambda, None] = {}
    for form in forms:
        for place in places(form):
            conjunction = conjuncts(place.part)
            names = [each.predicate for each in conjunction if isinstance(each, Application)]
            beside |= {(str(one), str(other)) for one in names for other in names if one != other}
            leaves |= {each: None for each in conjunction if is_leaf(each)}
            if place.holder and isinstance(place.part, Lambda):
                inside |= {(*place.holder, name) for name in predicates(place.part)}
                terms[place.part] = None
    return Contexts(tuple(leaves), frozenset(beside), frozenset(inside), tuple(terms))


def places(form: Form) -> Iterator[Place]:
    """Yield every part of a form, each before its own parts."""
    yield Place(form, lambda part: part)
    for number, child in enumerate(children(form)):
        holder = (str(form.predicate), number) if isinstance(form, Application) else None
        for inner in places(child):
            yield Place(
                inner.part,
                _rebuild_child(form, number, inner.rebuild),
                inner.holder or (holder if inner.part is child else None),
            )


def conjuncts(form: Form) -> tuple[Form, ...]:
    """Return the bodies of a λ or the arguments of ``and``; nothing for any other form."""
    is_conjunction = isinstance(form, Application) and form.predicate == "and"
    return children(form) if is_conjunction or isinstance(form, Lambda) else ()


def with_children(form: Form, parts: Sequence[Form]) -> Form:
    """Return a λ or an application with other parts."""
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(parts))
    if isinstance(form, Application):
        return replace(form, arguments=tuple(parts))
    return form


def is_leaf(form: Form) -> TypeGuard[Leaf]:
    """Return whether a form describes a variable, with only constants and variables as arguments."""
    if not isinstance(form, Application) or not isinstance(
        next(iter(form.arguments), None), Variable
    ):
        return False
    return not any(isinstance(each, Lambda | Application) for each in form.arguments)


def variables(form: Form) -> tuple[Variable, ...]:
    """Return the variables of a form in order of appearance."""
    return tuple(each for each in walk(form) if isinstance(each, Variable))


def _rebuild_child(form: Form, number: int, rebuild: Rebuild) -> Rebuild:
    parts = children(form)
    return lambda part: with_children(form, (*parts[:number], rebuild(part), *parts[number + 1 :]))
