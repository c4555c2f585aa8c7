"""What values of a task plan are: their kinds, where they are, and when two of them are the same."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from annotations.language.forms import (
    NAMING,
    NOUN,
    PERSON,
    PERSON_PREDICATES,
    PLACE_CLASSES,
    THING,
    kind_of_class,
)
from annotations.language.plans.descriptions import AT
from annotations.language.plans.plan import (
    Condition,
    Described,
    Named,
    Number,
    OpenValue,
    Operator,
    Referred,
    StepResult,
    TaskValue,
    Unresolved,
    Value,
    Words,
)

PLACE = "place"
# The kinds of values beside the tokens of entity classes.
KINDS = frozenset((PERSON, THING, PLACE, "attribute", "text", "number", "result"))


def kinds_of(value: TaskValue) -> frozenset[str]:
    """Return the kinds of a value, with the token of its class."""
    if isinstance(value, Referred):
        return kinds_of(value.value)
    if isinstance(value, Named):
        is_thing = kind_of_class(value.entity_class) not in ("", PERSON)
        of_class = THING if is_thing else kind_of_class(value.entity_class)
        place = PLACE if value.entity_class in PLACE_CLASSES else ""
        return frozenset((value.entity_class, of_class, place)) - {""}
    if isinstance(value, Described):
        return frozenset(("attribute",) if value.of else (_kind_of_described(value),))
    if isinstance(value, Words):
        return frozenset(("text",))
    if isinstance(value, Number):
        return frozenset(("number",))
    return frozenset(("result",)) if isinstance(value, StepResult) else frozenset()


def _kind_of_described(value: Described) -> str:
    if any(each.predicate in PERSON_PREDICATES for each in value.conditions):
        return PERSON
    is_place = any(
        isinstance(each, Named) and each.entity_class in PLACE_CLASSES
        for condition in value.conditions
        for each in condition.values
        if condition.predicate == NOUN
    )
    return PLACE if is_place else THING


def said_place(value: TaskValue) -> TaskValue | None:
    """Return where a value is by what is said of it; None if nothing is.

    That is what it is ``at``, else a place that another condition names, else where the thing is that it
    is beside or belongs to. A place is where it is itself.
    """
    if isinstance(value, Operator) or PLACE in kinds_of(value):
        return value
    if not isinstance(value, Described):
        return None
    if value.of is not None:
        return said_place(value.of)
    values = [each for condition in value.conditions for each in condition.values]
    at = [each for each in value.conditions if each.predicate == AT]
    direct = [each for condition in at for each in condition.values]
    direct += [
        each for each in values if isinstance(each, Named) and each.entity_class in PLACE_CLASSES
    ]
    if direct:
        return direct[0]
    inner = (said_place(each) for each in values if isinstance(each, Described))
    return next((each for each in inner if each is not None), None)


def without_place(value: Described) -> Described:
    """Return a description without what it is ``at``; unchanged where nothing else is said."""
    if value.of is not None:
        owner = without_place(value.of)
        return Described(value.id, value.short_text or value.text, (), value.attribute, owner)
    rest = tuple(each for each in value.conditions if each.predicate != AT)
    if not rest or len(rest) == len(value.conditions):
        return value
    text = value.short_text or value.text
    return Described(value.id, text, rest, short_text=text)


def content(value: TaskValue, around: tuple[str, ...] = ()) -> tuple[Any, ...]:
    """Return what two values with the same meaning have in common: no names of variables, no texts, no order
    of conditions, no attributes of entities.

    ``around`` are the ids of the descriptions that the value is part of.
    """
    if isinstance(value, Referred):
        return content(value.value, around)
    if isinstance(value, Named):
        return ("entity", value.entity_class, value.text)
    if isinstance(value, Words):
        return ("text", value.text)
    if isinstance(value, Number):
        return ("number", value.value)
    if isinstance(value, StepResult):
        return ("result", value.step)
    if isinstance(value, OpenValue):
        return ("open", value.entity_class)
    if isinstance(value, Operator):
        return ("operator",)
    if value.id in around:
        return ("this", len(around) - around.index(value.id))
    inside = (*around, value.id)
    if value.of is not None:
        return ("attribute", value.attribute, content(value.of, inside))
    conditions = (
        (condition.predicate, *(content(each, inside) for each in condition.values))
        for condition in value.conditions
    )
    return ("description", tuple(sorted(conditions, key=repr)))


def with_results(
    value: TaskValue, numbers: Mapping[int, int], ids: Mapping[str, str] | None = None
) -> TaskValue:
    """Return a value with other numbers for the steps whose results it uses, and other ids.

    A step that is not in ``numbers`` gives no result; an id that is not in ``ids`` stays. References stand
    for what they refer to.
    """
    if isinstance(value, StepResult):
        number = numbers.get(value.step)
        return OpenValue("") if number is None else StepResult(number)
    if isinstance(value, Referred):
        return with_results(value.value, numbers, ids)
    if not isinstance(value, Described):
        return value
    conditions = tuple(
        Condition(each.predicate, tuple(_plain(with_results(v, numbers, ids)) for v in each.values))
        for each in value.conditions
    )
    owner = value.of and with_results(value.of, numbers, ids)
    assert owner is None or isinstance(owner, Described)
    new_id = (ids or {}).get(value.id, value.id)
    return Described(new_id, value.text, conditions, value.attribute, owner, value.short_text)


def renumbered(
    unresolved: Unresolved,
    steps: Mapping[int, Sequence[int]],
    results: Mapping[int, int],
    ids: Mapping[str, str] | None = None,
) -> Unresolved:
    """Return what is not resolved with other numbers of steps.

    Args:
        steps: step → those that do what it does.
        results: step → the one that gives its result.
        ids: as in ``with_results``.
    """
    return replace(
        unresolved,
        steps=tuple(
            sorted({each for number in unresolved.steps for each in steps.get(number, ())})
        ),
        arguments=tuple(
            (name, with_results(value, results, ids)) for name, value in unresolved.arguments
        ),
        open=tuple(
            replace(each, asked_in=results.get(each.asked_in, 0)) for each in unresolved.open
        ),
    )


def ids_in(value: TaskValue) -> Iterator[str]:
    """Yield the ids of what a value describes, itself first."""
    if isinstance(value, Described):
        yield value.id
        for condition in value.conditions:
            for each in condition.values:
                yield from ids_in(each)
        if value.of is not None:
            yield from ids_in(value.of)


def is_named_person(value: TaskValue) -> bool:
    """Return whether a value describes somebody by a name, so that the same words mean the same person."""
    return isinstance(value, Described) and any(
        each.predicate == NAMING and any(isinstance(name, Named) for name in each.values)
        for each in value.conditions
    )


def _plain(value: TaskValue) -> Value:
    assert not isinstance(value, Operator)
    return value
