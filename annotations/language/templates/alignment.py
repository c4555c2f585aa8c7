"""Align two patterns unit by unit at the least cost (Wagner and Fischer, JACM 1974)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import log

from annotations.language.templates.units import Slot, Unit

# Two slots of different classes may correspond, as in "from the <room>" and "from the <location>".
OTHER_CLASS = 0.7
# The least weight of a unit, that of one in every pattern.
LEAST_WEIGHT = 0.1


@dataclass(frozen=True)
class Weights:
    """What a unit counts: more for rare ones, from ``LEAST_WEIGHT`` to 1 + ``LEAST_WEIGHT``."""

    frequencies: Counter[str]
    patterns: int

    def of(self, unit: Unit) -> float:
        share = (1 + self.frequencies[unit.label]) / (1 + self.patterns)
        return LEAST_WEIGHT - log(min(share, 1)) / log(2 + self.patterns)

    def distance(self, left: Unit, right: Unit) -> float:
        """Return what it costs to put one unit in the place of another."""
        if left.label == right.label:
            return 0
        whole = self.of(left) + self.of(right)
        if left.is_entity and right.is_entity:
            return whole * OTHER_CLASS
        if left.is_entity or right.is_entity:
            return 2 * whole
        shared = len(left.phrases & right.phrases) / len(left.phrases | right.phrases)
        return whole * (1 - shared)


def weigh(patterns: Iterable[Sequence[Unit]]) -> Weights:
    """Return the weights of units in patterns."""
    sets = [{unit.label for unit in pattern} for pattern in patterns]
    return Weights(Counter(label for labels in sets for label in labels), len(sets))


@dataclass(frozen=True)
class Alignment:
    """``pairs`` are (left unit, right unit); one side is None where the other has a unit more."""

    cost: float
    pairs: tuple[tuple[Unit | None, Unit | None], ...]

    def slots(self) -> dict[Slot, Slot]:
        """Return the right slot for each left one that has a counterpart."""
        both = ((left.slot, right.slot) for left, right in self.pairs if left and right)
        mapping: dict[Slot, Slot] = {}
        for left, right in both:
            if left is not None and right is not None:
                mapping.setdefault(left, right)
        return mapping


def align(left: Sequence[Unit], right: Sequence[Unit], weights: Weights) -> Alignment:
    """Return a cheapest alignment of two sequences of units."""
    costs = _costs(left, right, weights)
    i, j = len(left), len(right)
    pairs: list[tuple[Unit | None, Unit | None]] = []
    while i or j:
        here = costs[i][j]
        if i and j and here == costs[i - 1][j - 1] + weights.distance(left[i - 1], right[j - 1]):
            i, j = i - 1, j - 1
            pairs.append((left[i], right[j]))
        elif i and here == costs[i - 1][j] + weights.of(left[i - 1]):
            i -= 1
            pairs.append((left[i], None))
        else:
            j -= 1
            pairs.append((None, right[j]))
    return Alignment(costs[-1][-1], tuple(reversed(pairs)))


def _costs(left: Sequence[Unit], right: Sequence[Unit], weights: Weights) -> list[list[float]]:
    """Return the least cost for each pair of beginnings: [1 + left units, 1 + right units]."""
    gaps = [weights.of(unit) for unit in right]
    row = [0.0]
    for gap in gaps:
        row.append(row[-1] + gap)
    costs = [row]
    for unit in left:
        above, gap = costs[-1], weights.of(unit)
        row = [above[0] + gap]
        for j, other in enumerate(right):
            row.append(
                min(above[j] + weights.distance(unit, other), above[j + 1] + gap, row[j] + gaps[j])
            )
        costs.append(row)
    return costs
