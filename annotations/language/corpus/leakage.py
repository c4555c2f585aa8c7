"""What validation and test parts share with training: texts, source commands, forms, near duplicates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from rapidfuzz import process
from rapidfuzz.distance import Levenshtein

from annotations.language.corpus.splitting import Criterion, SplitItem

# Normalised Levenshtein similarity, 1 − edits / characters of the longer text. Chosen over the Jaccard
# distance of words because it notices inflections, typing errors and a different order of words.
NEAR = 0.9
# One comparison takes about 0.1 µs, so this many take two seconds.
MOST_COMPARISONS = 20_000_000
PLURALS = {
    Criterion.COMMAND: "utterances",
    Criterion.SOURCE_COMMAND: "source commands",
    Criterion.LOGICAL_FORM: "logical forms",
}


@dataclass(frozen=True, slots=True)
class Leak:
    """How much of ``part`` also occurs in the training part.

    ``what`` names what is compared, in the plural. ``pairs`` counts the pairs of ``part`` that have
    one; ``shared`` counts those whose one also occurs in training.
    """

    part: str
    what: str
    pairs: int
    shared: int

    @property
    def share(self) -> float:
        """The shared fraction, from 0 to 1; 0 if nothing is counted."""
        return self.shared / self.pairs if self.pairs else 0.0

    @property
    def percent(self) -> float:
        return 100 * self.share


@dataclass(frozen=True, slots=True)
class NearDuplicate:
    """An utterance and the training utterance closest to it; ``similarity`` is between ``NEAR`` and 1."""

    utterance: str
    training: str
    similarity: float


@dataclass(frozen=True, slots=True)
class NearDuplicates:
    """``leak`` counts pairs; ``duplicates`` lists each distinct utterance once, most similar first."""

    leak: Leak
    duplicates: tuple[NearDuplicate, ...]


def shared(part: str, items: Sequence[SplitItem], train: Sequence[SplitItem]) -> Iterator[Leak]:
    """Count the utterances, source commands and forms of ``items`` that also occur in ``train``.

    Texts are compared ignoring case and spacing. An item without a source command is not counted
    among the source commands.
    """
    for criterion, what in PLURALS.items():
        seen = set(_keys(train, criterion))
        keys = list(_keys(items, criterion))
        if keys:
            yield Leak(part, what, len(keys), sum(key in seen for key in keys))


def near_duplicates(
    part: str, items: Sequence[SplitItem], train: Sequence[SplitItem]
) -> NearDuplicates:
    """Find the utterances of ``items`` that are not in ``train`` but are similar to one that is.

    Similar means at least ``NEAR``. Texts are compared and shown in lower case with single spaces.
    Of equally similar training utterances the first in alphabetical order is taken. ``comparisons``
    says what this costs.
    """
    seen = sorted(set(_keys(train, Criterion.COMMAND)))
    keys = list(_keys(items, Criterion.COMMAND))
    nearest = {}
    for key in sorted(set(keys).difference(seen)):
        # The best score so far is the next cutoff: faster than a matrix, and with less memory.
        best = process.extractOne(
            key, seen, scorer=Levenshtein.normalized_similarity, score_cutoff=NEAR
        )
        if best:
            nearest[key] = NearDuplicate(key, best[0], best[1])
    leak = Leak(part, "near duplicates", len(keys), sum(key in nearest for key in keys))
    return NearDuplicates(leak, tuple(sorted(nearest.values(), key=lambda each: -each.similarity)))


def comparisons(items: Sequence[SplitItem], train: Sequence[SplitItem]) -> int:
    """Return the largest number of comparisons that ``near_duplicates`` may make."""
    return len(items) * len(train)


def _keys(items: Iterable[SplitItem], criterion: Criterion) -> Iterator[str]:
    for item in items:
        if criterion is not Criterion.SOURCE_COMMAND or item.source_command:
            yield item.key(criterion)
