"""Check whether an entity satisfies the ``where`` clause of a wildcard (FORMATS §1)."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator

from annotations.language.ontology import Entity
from annotations.language.symbols import Combination, Comparison, Condition, Negation, Wildcard

Value = str | float | bool | None
_ORDERS: dict[str, Callable[[float, float], bool]] = {
    ">": operator.gt,
    ">=": operator.ge,
    "<": operator.lt,
    "<=": operator.le,
}


def holds(condition: Condition, entity: Entity, value_of: Callable[[Wildcard], str]) -> bool:
    """Return whether ``entity`` satisfies ``condition``.

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
    return _compares(entity.attribute(condition.property), condition.operator, wanted)


def wildcards_in(condition: Condition | None) -> Iterator[Wildcard]:
    """Yield the wildcards that a condition uses as values."""
    if isinstance(condition, Negation):
        yield from wildcards_in(condition.operand)
    elif isinstance(condition, Combination):
        yield from wildcards_in(condition.left)
        yield from wildcards_in(condition.right)
    elif isinstance(condition, Comparison) and isinstance(condition.value, Wildcard):
        yield condition.value


def _compares(actual: str | None, sign: str, wanted: Value) -> bool:
    if sign in _ORDERS:
        left, right = _number(actual), _number(wanted)
        return left is not None and right is not None and _ORDERS[sign](left, right)
    return _equals(actual, wanted) == (sign == "=")


def _equals(actual: str | None, wanted: Value) -> bool:
    if isinstance(wanted, bool):
        return ((actual or "").lower() == "true") == wanted
    if wanted is None or actual is None:
        return actual is wanted
    if isinstance(wanted, float):
        return _number(actual) == wanted
    return actual.lower() == wanted.lower()


def _number(value: Value) -> float | None:
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return None
