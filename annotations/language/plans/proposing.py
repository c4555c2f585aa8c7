"""Propose how a robot does the actions that no recipe covers: each as one primitive, called and said as its predicate.

What is proposed comes from the signature of a predicate and from its English alone. So it has no effects: a form does
not say what an action does to the world. Only a person can write that.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from annotations.language.forms import Application
from annotations.language.plans.behavior_tree import TAKEN_NAMES, node_name
from annotations.language.plans.book import RecipeBook, default_book
from annotations.language.plans.machine import as_robot_says
from annotations.language.plans.plan import ASK
from annotations.language.plans.planning import arguments_of
from annotations.language.plans.reading import read_primitive, read_recipe
from annotations.language.plans.rows import (
    ActionPattern,
    Call,
    Effect,
    EffectKind,
    Name,
    Parameter,
    Primitive,
    PrimitiveParameter,
    Recipe,
)
from annotations.language.texts import LanguageError
from annotations.language.world import Predicate, PredicateKind, said_of, sample_use


def with_proposals(book: RecipeBook, predicates: Mapping[str, Predicate]) -> RecipeBook:
    """Return the book with what is proposed for the actions of a world that it does not cover."""
    return replace(book, proposed=propose(book, predicates))


def propose(book: RecipeBook, predicates: Mapping[str, Predicate]) -> RecipeBook:
    """Return the rows that ``book`` lacks: a primitive for each action, and a recipe for each number of arguments.

    A question to the operator is taken from the book that a new world starts with.
    """
    primitives: list[Primitive] = []
    recipes: list[Recipe] = []
    taken = {node_name(each.name) for each in book.primitives}
    for each in () if book.recipes_of(ASK) else default_book().recipes_of(ASK):
        asking = [default_book().primitive(call.primitive) for call in each.calls]
        if taken.isdisjoint(node_name(primitive.name) for primitive in asking if primitive):
            primitives += filter(None, asking)
            recipes.append(each)
    for predicate in predicates.values():
        patterns = [each.pattern for each in book.recipes_of(predicate.name)]
        covered = {frozenset(_names(each)) for each in patterns if not each.restrictions}
        uses = [each for each in _uses(predicate) if frozenset(each.names) not in covered]
        for group in _groups(uses):
            names = taken | {node_name(each.name) for each in primitives}
            primitive = _primitive(predicate, group, names)
            rows = [_recipe(predicate.name, each.names, primitive.name) for each in group]
            with suppress(LanguageError):  # a name that no row can have
                recipes += [read_recipe(str(each)) for each in rows]
                primitives.append(_readable(primitive))
    return RecipeBook(tuple(primitives), tuple(recipes))


def arguments_by_action(predicates: Mapping[str, Predicate]) -> Mapping[str, Collection[str]]:
    """Return what plans call the arguments of each action."""
    return {
        name: dict.fromkeys(argument for use in _uses(each) for argument in use.names)
        for name, each in predicates.items()
    }


@dataclass(frozen=True, slots=True)
class _Use:
    """An action with sample arguments, and what plans call these."""

    form: Application
    names: tuple[str, ...]


def _names(pattern: ActionPattern) -> tuple[str, ...]:
    return tuple(each.name for each in pattern.parameters)


def _uses(predicate: Predicate) -> Iterator[_Use]:
    """Yield an action with each set of arguments that it takes, the largest first."""
    seen = set()
    signatures = predicate.signatures if predicate.kind is PredicateKind.ACTION else ()
    for signature in sorted(signatures, key=lambda each: -len(each.arguments)):
        form = sample_use(predicate, signature)
        names = arguments_of(form, predicate)
        if frozenset(names) not in seen:
            seen.add(frozenset(names))
            yield _Use(form, names)


def _groups(uses: Iterable[_Use]) -> Sequence[Sequence[_Use]]:
    """Return the uses that one primitive can do: the fewer arguments are the first of the more."""
    groups: list[list[_Use]] = []
    for use in uses:
        fitting = (g for g in groups if g[0].names[: len(use.names)] == use.names)
        group = next(fitting, None)
        if group is None:
            groups.append([use])
        else:
            group.append(use)
    return groups


def _primitive(predicate: Predicate, uses: Sequence[_Use], taken: Collection[str]) -> Primitive:
    """Return what does these uses. It has the name of the predicate, with a number where another has that."""
    needed = len(uses[-1].names)
    parameters = (PrimitiveParameter(each, n >= needed) for n, each in enumerate(uses[0].names))
    said, learnt = zip(
        *(said_of(use.form, predicate, use.names) for use in reversed(uses)), strict=True
    )
    noun = next(filter(None, learnt), "")
    name = next(
        each
        for each in (predicate.name, *(f"{predicate.name}_{n}" for n in range(2, len(taken) + 3)))
        if each not in TAKEN_NAMES and node_name(each) not in taken
    )
    return Primitive(
        name,
        tuple(parameters),
        tuple(dict.fromkeys(map(as_robot_says, said))),
        (Effect(EffectKind.LEARNS, noun=as_robot_says(noun)),) if noun else (),
    )


def _readable(primitive: Primitive) -> Primitive:
    """Return the primitive as its row reads; without words where these cannot stand in a row. Raises LanguageError."""
    try:
        return read_primitive(str(primitive))
    except LanguageError:
        return read_primitive(str(replace(primitive, said=(), effects=())))


def _recipe(action: str, names: Sequence[str], primitive: str) -> Recipe:
    call = Call(primitive, tuple(map(Name, names)))
    return Recipe(ActionPattern(action, tuple(map(Parameter, names))), (call,))
