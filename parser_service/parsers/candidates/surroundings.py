"""Where the parts of forms stand, and what stands beside them: the types that closure keeps to."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeGuard

from annotations.language.logic import (
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
    """A part of a form; ``rebuild`` gives the form with something else in its place.

    ``holder`` is the application around it with the number of the argument, where there is one.
    """

    part: Form
    rebuild: Rebuild
    holder: tuple[str, int] | None = None


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What has been seen in a set of forms."""

    leaves: tuple[Leaf, ...]  # descriptions, as ``at($1, <room>)``
    beside: frozenset[tuple[str, str]]  # predicates in one conjunction
    inside: frozenset[tuple[str, int, str]]  # action, argument, predicate anywhere in it
    terms: tuple[Lambda, ...]  # what a λ around no action describes

    def go_together(self, leaf: Leaf, others: Iterable[Form]) -> bool:
        """Whether ``leaf`` says something new that has been said beside each of ``others``."""
        names = [each.predicate for each in others if isinstance(each, Application)]
        mine = leaf.predicate
        return all(name != mine and (mine, name) in self.beside for name in names)

    def may_hold(self, holder: tuple[str, int], term: Lambda) -> bool:
        """Whether everything that ``term`` speaks of has been seen in that argument."""
        return all((*holder, name) in self.inside for name in predicates(term))


def look_around(forms: Sequence[Form]) -> Surroundings:
    """The surroundings that ``forms`` show."""
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
    return Surroundings(tuple(leaves), frozenset(beside), frozenset(inside), tuple(terms))


def places(form: Form) -> Iterator[Place]:
    """Every part of a form, each before its parts."""
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
    """The bodies of a λ or the arguments of ``and``; empty for everything else."""
    is_conjunction = isinstance(form, Application) and form.predicate == "and"
    return children(form) if is_conjunction or isinstance(form, Lambda) else ()


def with_children(form: Form, parts: Sequence[Form]) -> Form:
    """A λ or application around other parts."""
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(parts))
    if isinstance(form, Application):
        return replace(form, arguments=tuple(parts))
    return form


def is_leaf(form: Form) -> TypeGuard[Leaf]:
    """Whether a form describes a variable by constants and other variables alone."""
    if not isinstance(form, Application) or not isinstance(
        next(iter(form.arguments), None), Variable
    ):
        return False
    return not any(isinstance(each, Lambda | Application) for each in form.arguments)


def variables(form: Form) -> tuple[Variable, ...]:
    """The variables of a form in order of appearance."""
    return tuple(each for each in walk(form) if isinstance(each, Variable))


def _rebuild_child(form: Form, number: int, rebuild: Rebuild) -> Rebuild:
    parts = children(form)
    return lambda part: with_children(form, (*parts[:number], rebuild(part), *parts[number + 1 :]))
