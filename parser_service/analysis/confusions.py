"""Which predicates are taken for which, and which argument is filled with what instead.

Both count pairs of label and answer; each distinct pair is read once, so that a million pairs cost
little more than their distinct ones.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from annotations.language.forms import (
    CONJUNCTION,
    Application,
    Difference,
    diff_unordered,
    read_or_none,
)
from annotations.language.world import ArgumentKind, argument_kind
from parser_service.analysis.arrays import Ints
from parser_service.analysis.encoded_labels import EncodedLabels, distinct_pairs, encode

NOTHING = "nothing"


@dataclass(frozen=True, eq=False, slots=True)
class HeadConfusion:
    """``counts[i, j]`` of the pairs have a label with head predicate ``heads[i]`` and an answer with
    ``heads[j]``. Heads of labels come first, the most frequent ones at the front."""

    heads: tuple[str, ...]
    counts: Ints  # [heads, heads]

    def errors(self) -> list[tuple[str, str, int]]:
        """Return (label's head, answer's head, count) for each confusion, the most frequent first."""
        rows, columns = np.nonzero(self.counts)
        cells = [
            (self.heads[i], self.heads[j], int(self.counts[i, j]))
            for i, j in zip(rows.tolist(), columns.tolist(), strict=True)
            if i != j
        ]
        return sorted(cells, key=lambda cell: (-cell[2], cell[0], cell[1]))


@dataclass(frozen=True, slots=True)
class SlotConfusion:
    """In ``count`` pairs, argument ``place`` (from 1) of ``predicate`` is filled with the kind ``gold`` in the
    label and ``predicted`` in the answer. Kinds are those of signatures, or ``NOTHING``."""

    predicate: str
    place: int
    gold: str
    predicted: str
    count: int

    @property
    def is_error(self) -> bool:
        return self.gold != self.predicted


def confuse_heads(gold: EncodedLabels[str], predicted: EncodedLabels[str]) -> HeadConfusion:
    """Count head predicates of labels against those of answers, [pairs] each."""
    import pandas

    first, second, counts = distinct_pairs(gold.codes, predicted.codes)
    said = [gold.values[code] for code in first]
    answered = [predicted.values[code] for code in second]
    pairs = pandas.DataFrame({"said": said, "answered": answered, "count": counts})
    table = pairs.pivot_table("count", "said", "answered", "sum", fill_value=0)
    heads = list(dict.fromkeys(_by_frequency(table.sum(axis=1)) + _by_frequency(table.sum())))
    square = table.reindex(index=heads, columns=heads, fill_value=0)
    return HeadConfusion(tuple(heads), square.to_numpy(np.int64))


def confuse_slots(gold: Sequence[str], predicted: Sequence[str]) -> tuple[SlotConfusion, ...]:
    """Count what fills the arguments of predicates that label and answer share.

    Predicates correspond as in the difference of the two forms, whatever the order of conjuncts. Slots
    that a variable fills in both are left out. Confusions come first, the most frequent at the front.

    Args:
        gold: forms as text, [pairs].
        predicted: the answers in the same order; what is not a form has no slots.

    Raises:
        ValueError: there are not as many answers as labels.
    """
    if len(gold) != len(predicted):
        raise ValueError(f"{len(predicted)} answers do not fit {len(gold)} labels.")
    labels, answers = encode(gold), encode(predicted)
    read_labels = [read_or_none(text) for text in labels.values]
    read_answers = [read_or_none(text) for text in answers.values]
    totals: Counter[tuple[str, int, str, str]] = Counter()
    pairs = distinct_pairs(labels.codes, answers.codes)
    for first, second, count in zip(*(column.tolist() for column in pairs), strict=True):
        left, right = read_labels[first], read_answers[second]
        if left is not None and right is not None:
            for slot in _slots(diff_unordered(left, right)):
                totals[slot] += count
    rows = [SlotConfusion(*slot, count) for slot, count in sorted(totals.items())]
    return tuple(sorted(rows, key=lambda row: (not row.is_error, -row.count)))


def _by_frequency(counts: Any) -> list[str]:
    return sorted(counts.index, key=lambda name: (-counts[name], name))


def _slots(node: Difference) -> Iterator[tuple[str, int, str, str]]:
    """Yield predicate, place and both fillers for each slot of the predicates that correspond."""
    left, right = node.left, node.right
    if (
        isinstance(left, Application)
        and isinstance(right, Application)
        and left.predicate == right.predicate != CONJUNCTION
    ):
        for place in range(max(len(left.arguments), len(right.arguments))):
            gold, predicted = _filler(left, place), _filler(right, place)
            if not gold == predicted == ArgumentKind.VARIABLE:
                yield str(left.predicate), place + 1, gold, predicted
    for child in node.children:
        yield from _slots(child)


def _filler(form: Application, place: int) -> str:
    has_place = place < len(form.arguments)
    return str(argument_kind(form.arguments[place])) if has_place else NOTHING
