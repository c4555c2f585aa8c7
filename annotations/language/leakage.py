"""What validation and test parts share with training: texts, source commands, forms, near duplicates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from rapidfuzz import process
from rapidfuzz.distance import Levenshtein

from annotations.language.splitting import Criterion, SplitItem

# Normalised Levenshtein similarity, 1 − edits / characters of the longer text. Chosen over the Jaccard
# distance of words: it sees inflections and typing errors, and that the order of words differs.
NEAR = 0.9
# One comparison takes some 0.1 µs; above this many, seconds.
MOST_COMPARISONS = 20_000_000
PLURALS = {
    Criterion.COMMAND: "utterances",
    Criterion.SOURCE_COMMAND: "source commands",
    Criterion.LOGICAL_FORM: "logical forms",
}


@dataclass(frozen=True, slots=True)
class Leak:
    """How much of what stands in ``part`` stands in the training part too.

    ``what`` is a plural. ``pairs`` counts the pairs of ``part`` that have such a thing at all,
    ``shared`` those of them whose thing training has seen.
    """

    part: str
    what: str
    pairs: int
    shared: int

    @property
    def share(self) -> float:
        """In 0–1; 0 where nothing is counted."""
        return self.shared / self.pairs if self.pairs else 0.0

    @property
    def percent(self) -> float:
        return 100 * self.share


@dataclass(frozen=True, slots=True)
class NearDuplicate:
    """An utterance and the training utterance nearest to it; ``similarity`` in ``NEAR``–1."""

    utterance: str
    training: str
    similarity: float


@dataclass(frozen=True, slots=True)
class NearDuplicates:
    """``leak`` counts pairs; ``found`` has each distinct utterance once, the most similar first."""

    leak: Leak
    found: tuple[NearDuplicate, ...]


def shared(part: str, items: Sequence[SplitItem], train: Sequence[SplitItem]) -> Iterator[Leak]:
    """The utterances, source commands and forms of ``items`` that ``train`` has too.

    Texts are compared without regard to case and spacing. An item without a source command is not
    counted among the source commands.
    """
    for criterion, what in PLURALS.items():
        seen = set(_keys(train, criterion))
        keys = list(_keys(items, criterion))
        if keys:
            yield Leak(part, what, len(keys), sum(key in seen for key in keys))


def near_duplicates(
    part: str, items: Sequence[SplitItem], train: Sequence[SplitItem]
) -> NearDuplicates:
    """The utterances of ``items`` that training has not, but has one at least ``NEAR`` to.

    Texts are compared without regard to case and spacing, and shown so. Among equally near training
    utterances the first in alphabetical order. ``comparisons`` tells what it costs.
    """
    seen = sorted(set(_keys(train, Criterion.COMMAND)))
    keys = list(_keys(items, Criterion.COMMAND))
    nearest = {}
    for key in sorted(set(keys).difference(seen)):
        # Passes the best score on as the cutoff: faster here than a matrix, and without its memory.
        best = process.extractOne(
            key, seen, scorer=Levenshtein.normalized_similarity, score_cutoff=NEAR
        )
        if best:
            nearest[key] = NearDuplicate(key, best[0], best[1])
    leak = Leak(part, "near duplicates", len(keys), sum(key in nearest for key in keys))
    return NearDuplicates(leak, tuple(sorted(nearest.values(), key=lambda each: -each.similarity)))


def comparisons(items: Sequence[SplitItem], train: Sequence[SplitItem]) -> int:
    """The most comparisons of two utterances that ``near_duplicates`` may make."""
    return len(items) * len(train)


def _keys(items: Iterable[SplitItem], criterion: Criterion) -> Iterator[str]:
    for item in items:
        if criterion is not Criterion.SOURCE_COMMAND or item.source_command:
            yield item.key(criterion)
