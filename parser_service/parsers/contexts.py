"""The contexts in which parts of forms occur: closure keeps to those that it has seen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeGuard, TypeVar

from annotations.language.forms import (
    CONJUNCTION,
    Application,
    Form,
    Lambda,
    Variable,
    children,
    predicates,
    walk,
)
from parser_service.parsers.interface import Check, keep_going

Rebuild = Callable[[Form], Form]
Leaf = Application
Part = TypeVar("Part")
MOST_PARTS = 300  # descriptions, and λs, that a change puts in: the most frequent ones of many


@dataclass(frozen=True, slots=True)
class Subform:
    """A part of a form; ``rebuild`` returns the form with something else in its place.

    ``holder`` is the application that has it as an argument, with the argument's number.
    """

    part: Form
    rebuild: Rebuild
    holder: tuple[str, int] | None = None


@dataclass(frozen=True, slots=True)
class Contexts:
    """The contexts seen in a set of forms."""

    leaves: Mapping[Leaf, tuple[Variable, ...]]  # descriptions, as ``at($1, <room>)``
    beside: frozenset[tuple[str, str]]  # predicates in one conjunction
    inside: frozenset[tuple[str, int, str]]  # action, argument, predicate anywhere in it
    terms: tuple[Lambda, ...]  # the λs that are arguments
    _fitting: dict[tuple[str, int], tuple[Lambda, ...]] = field(default_factory=dict)

    def go_together(self, leaf: Leaf, others: Iterable[Form]) -> bool:
        """Return whether ``leaf`` has another predicate than each of ``others`` and was seen beside each of them."""
        names = [each.predicate for each in others if isinstance(each, Application)]
        mine = leaf.predicate
        return all(name != mine and (mine, name) in self.beside for name in names)

    def fitting(self, holder: tuple[str, int]) -> tuple[Lambda, ...]:
        """Return the terms of which every predicate was seen in the argument ``holder``."""
        if holder not in self._fitting:
            self._fitting[holder] = tuple(
                term
                for term in self.terms
                if all((*holder, name) in self.inside for name in predicates(term))
            )
        return self._fitting[holder]


def find_contexts(forms: Sequence[Form], check: Check = keep_going) -> Contexts:
    """Collect the contexts of all parts of ``forms``."""
    leaves: Counter[Leaf] = Counter()
    beside: set[tuple[str, str]] = set()
    inside: set[tuple[str, int, str]] = set()
    terms: Counter[Lambda] = Counter()
    for form in forms:
        check()
        for place in places(form):
            conjunction = conjuncts(place.part)
            names = [each.predicate for each in conjunction if isinstance(each, Application)]
            beside |= {(str(one), str(other)) for one in names for other in names if one != other}
            leaves.update(each for each in conjunction if is_leaf(each))
            if place.holder and isinstance(place.part, Lambda):
                inside |= {(*place.holder, name) for name in predicates(place.part)}
                terms[place.part] += 1
    return Contexts(
        {leaf: variables(leaf) for leaf in _most_frequent(leaves)},
        frozenset(beside),
        frozenset(inside),
        _most_frequent(terms),
    )


def _most_frequent(counts: Counter[Part]) -> tuple[Part, ...]:
    """Return at most ``MOST_PARTS`` of what was counted, in the order in which it was seen first."""
    kept = {part for part, _ in counts.most_common(MOST_PARTS)}
    return tuple(part for part in counts if part in kept)


def places(form: Form) -> Iterator[Subform]:
    """Yield every part of a form, each before its own parts."""
    yield Subform(form, lambda part: part)
    for number, child in enumerate(children(form)):
        holder = (str(form.predicate), number) if isinstance(form, Application) else None
        for inner in places(child):
            yield Subform(
                inner.part,
                _rebuild_child(form, number, inner.rebuild),
                inner.holder or (holder if inner.part is child else None),
            )


def conjuncts(form: Form) -> tuple[Form, ...]:
    """Return the bodies of a λ or the arguments of ``and``; nothing for any other form."""
    is_conjunction = isinstance(form, Application) and form.predicate == CONJUNCTION
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
