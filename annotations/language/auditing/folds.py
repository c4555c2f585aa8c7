"""Folds for answers of a parser that did not see the pair."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from random import Random

from annotations.language.auditing.findings import LabelledPair

LEAST_FOLDS, MOST_FOLDS = 2, 20


def source_key(pair: LabelledPair) -> str:
    """Return what pairs share that belong in one fold: the source command, or else the utterance."""
    return " ".join((pair.source_command or pair.utterance).casefold().split())


def assign_folds(pairs: Iterable[LabelledPair], count: int, seed: int = 0) -> dict[str, int]:
    """Return the fold, 0 to ``count`` - 1, of each ``source_key``. Folds have about as many pairs each.

    The order of the pairs has no effect.

    Raises:
        ValueError: a sentence where ``count`` is out of range or there are fewer keys than folds.
    """
    if not LEAST_FOLDS <= count <= MOST_FOLDS:
        raise ValueError(
            f"The number of folds is {count}; it has to be {LEAST_FOLDS} to {MOST_FOLDS}."
        )
    sizes = Counter(map(source_key, pairs))
    if len(sizes) < count:
        raise ValueError(
            f"There are pairs of {len(sizes)} source commands, too few for {count} folds."
        )
    return _fill(sorted(sizes), sizes, count, seed)


def _fill(keys: Sequence[str], sizes: Counter[str], count: int, seed: int) -> dict[str, int]:
    shuffled = list(keys)
    Random(seed).shuffle(shuffled)
    filled = [0] * count
    folds = {}
    for key in sorted(shuffled, key=lambda each: -sizes[each]):
        fold = filled.index(min(filled))
        folds[key] = fold
        filled[fold] += sizes[key]
    return folds
