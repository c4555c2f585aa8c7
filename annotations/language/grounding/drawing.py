"""Draw an entity for each wildcard at random: no value twice in a class, every constraint kept."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from random import Random

from annotations.language.forms import (
    Combination,
    Comparison,
    Condition,
    Negation,
    Wildcard,
    print_wildcard,
)
from annotations.language.texts import LanguageError
from annotations.language.world import Entity, Ontology

Identity = tuple[str, int | None]
Drawn = Mapping[Identity, Entity]

_ATTEMPTS = 100
Value = str | float | bool | None
_ORDERS: dict[str, Callable[[float, float], bool]] = {
    ">": operator.gt,
    ">=": operator.ge,
    "<": operator.lt,
    "<=": operator.le,
}


def draw(
    wildcards: Iterable[Wildcard], ontology: Ontology, random: Random
) -> dict[Identity, Entity]:
    """Draw one entity for each identity among the wildcards, except void and pronouns.

    The entity of an identity satisfies all of its wildcards. Different identities of a class get
    different texts whenever that is possible. If a condition refers to another wildcard, up to 100
    draws look for values that fit together.

    Raises:
        LanguageError: no entity satisfies a wildcard, or there are too few for all of them.
    """
    slots: dict[Identity, list[Wildcard]] = {}
    for wildcard in wildcards:
        if wildcard.entity_class:
            slots.setdefault(wildcard.identity, []).append(wildcard)
    later = {
        key: slot
        for key, slot in slots.items()
        if any(True for each in slot for _ in wildcards_in(each.where))
    }
    first = {key: each for key, each in slots.items() if key not in later}
    order = _in_order_of_reference(later)
    for attempts_left in range(_ATTEMPTS if later else 1, 0, -1):
        drawn: dict[Identity, Entity] = {}
        _match(first, drawn, ontology, random)
        try:
            for key in order:
                _match({key: later[key]}, drawn, ontology, random)
        except LanguageError:
            if attempts_left == 1:
                raise
        else:
            break
    return drawn


def _match(
    slots: Mapping[Identity, list[Wildcard]],
    drawn: dict[Identity, Entity],
    ontology: Ontology,
    random: Random,
) -> None:
    """Find a maximum bipartite matching by augmenting paths (Kuhn 1955), tried in random order."""
    taken = {_key(entity): identity for identity, entity in drawn.items()}
    fixed = frozenset(taken)
    candidates = {
        key: [each for each in _candidates(slot, ontology, drawn) if _key(each) not in fixed]
        for key, slot in slots.items()
    }
    order = list(slots)
    random.shuffle(order)
    for key in order:
        random.shuffle(candidates[key])
    for key in order:
        if not _augment(key, candidates, drawn, taken, set()):
            raise LanguageError(
                f"the ontology has too few values for every {_write(slots[key][0])} to be different "
                f"({len(candidates[key])} fit)",
                hint="add entities, or give wildcards that may be equal the same name and number",
            )


def _augment(
    key: Identity,
    candidates: Mapping[Identity, list[Entity]],
    drawn: dict[Identity, Entity],
    taken: dict[tuple[str, str], Identity],
    tried: set[tuple[str, str]],
) -> bool:
    for entity in candidates[key]:
        value = _key(entity)
        if value in tried:
            continue
        tried.add(value)
        if value not in taken or _augment(taken[value], candidates, drawn, taken, tried):
            taken[value] = key
            drawn[key] = entity
            return True
    return False


def _candidates(slot: list[Wildcard], ontology: Ontology, drawn: Drawn) -> list[Entity]:
    def value_of(wildcard: Wildcard) -> str:
        return drawn[wildcard.identity].text if wildcard.identity in drawn else ""

    candidates = [
        entity
        for entity in ontology.of_class(slot[0].entity_class)
        if all(is_of_type(entity, wildcard) for wildcard in slot)
        and all(each.where is None or holds(each.where, entity, value_of) for each in slot)
    ]
    if not candidates:
        raise LanguageError(
            f"the ontology has nothing for {' and '.join(map(_write, slot))}",
            hint="add such an entity, or relax the wildcard",
        )
    return candidates


def is_of_type(entity: Entity, wildcard: Wildcard) -> bool:
    """Return whether an entity has the type that a wildcard asks for.

    A missing attribute means what the generator assumes: a known object, a female name.
    """
    restriction = wildcard.restriction
    if restriction in ("placement", "beacon"):
        return entity.is_set(f"is{restriction}")
    if not restriction or restriction == "room":
        return True
    attribute, default = {"object": ("type", "known"), "name": ("gender", "female")}[wildcard.kind]
    return (entity.attribute(attribute) or default).lower() == restriction


def may_fill(entity: Entity, wildcard: Wildcard) -> bool:
    """Return whether an entity of its class fits a wildcard; a condition on another wildcard is taken to hold."""
    if not is_of_type(entity, wildcard):
        return False
    condition = wildcard.where
    if condition is None or any(True for _ in wildcards_in(condition)):
        return True
    return holds(condition, entity, lambda other: "")


def _key(entity: Entity) -> tuple[str, str]:
    """Return what tells values apart: the spoken text, so two sinks are one value."""
    return entity.entity_class, entity.text.lower()


def _write(wildcard: Wildcard) -> str:
    """Print a wildcard as its author wrote it, without a negative number, which was added later."""
    is_numbered = wildcard.id is not None and wildcard.id >= 0
    return print_wildcard(replace(wildcard, id=wildcard.id if is_numbered else None, meta=()))


def _in_order_of_reference(later: Mapping[Identity, list[Wildcard]]) -> list[Identity]:
    """Return the identities so that each comes after those it refers to.

    Raises:
        LanguageError: two wildcards refer to each other.
    """
    waiting = {
        key: {inner.identity for each in slot for inner in wildcards_in(each.where)} & later.keys()
        for key, slot in later.items()
    }
    order: list[Identity] = []
    while waiting:
        ready = [key for key, others in waiting.items() if others <= set(order)]
        if not ready:
            stuck = _write(later[next(iter(waiting))][0])
            raise LanguageError(
                f"the condition of {stuck} refers back to itself",
                hint="remove the reference that closes the circle",
            )
        order += ready
        waiting = {key: others for key, others in waiting.items() if key not in ready}
    return order


def holds(condition: Condition, entity: Entity, value_of: Callable[[Wildcard], str]) -> bool:
    """Return whether ``entity`` satisfies ``condition`` (docs/reference/formats.md, Conditions and notes).

    Texts are compared ignoring case. A property that the entity does not have is null, and false if
    it is compared with a truth value. Only numbers have an order. ``value_of`` gives the text of a
    wildcard that is used as a value.
    """
    if isinstance(condition, Negation):
        return not holds(condition.operand, entity, value_of)
    if isinstance(condition, Combination):
        left = holds(condition.left, entity, value_of)
        right = holds(condition.right, entity, value_of)
        return {"and": left and right, "or": left or right, "xor": left != right}[
            condition.operator
        ]
    value = condition.value
    wanted = value_of(value) if isinstance(value, Wildcard) else value
    actual, sign = entity.attribute(condition.property), condition.operator
    if sign in _ORDERS:
        number, limit = _number(actual), _number(wanted)
        return number is not None and limit is not None and _ORDERS[sign](number, limit)
    if isinstance(wanted, bool):
        is_equal = ((actual or "").lower() == "true") == wanted
    elif wanted is None or actual is None:
        is_equal = actual is wanted
    elif isinstance(wanted, float):
        is_equal = _number(actual) == wanted
    else:
        is_equal = actual.lower() == wanted.lower()
    return is_equal == (sign == "=")


def wildcards_in(condition: Condition | None) -> Iterator[Wildcard]:
    """Yield the wildcards that a condition uses as values."""
    if isinstance(condition, Negation):
        yield from wildcards_in(condition.operand)
    elif isinstance(condition, Combination):
        yield from wildcards_in(condition.left)
        yield from wildcards_in(condition.right)
    elif isinstance(condition, Comparison) and isinstance(condition.value, Wildcard):
        yield condition.value


def _number(value: Value) -> float | None:
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return None
