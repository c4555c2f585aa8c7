"""What a cell of an accuracy table says by one measure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from statistics import fmean

from annotations.language.corpus import harmonic_mean
from parser_service.analysis.clustered import Parts
from parser_service.analysis.outcomes import interval_of_scores
from parser_service.analysis.scores import OverSeeds, over_seeds
from parser_service.models import Evaluation
from parser_service.models.evaluations import KNOWN_FORMS, UNSEEN, PartFigure, reach_of
from parser_service.results.measures import Measure, count_of, interval_of, share_of


@dataclass(frozen=True, slots=True)
class AccuracyFigure:
    """What a cell says by one measure.

    ``interval``, fractions of 1, is the 95 % interval: of clusters, and of several seeds. By form the figure is the
    harmonic mean of accuracy on unseen and on known forms, which ``parts`` has; where known forms were
    not held out it is that on unseen forms ``alone``. ``note`` says what the figure means; ``published``
    is the paper's figure in percent where it is to be shown. ``counted`` is what comparisons need, None
    where answers were not counted by cluster.
    """

    measure: Measure
    over_seeds: OverSeeds
    interval: tuple[float, float]
    note: str
    published: float | None = None
    is_best: bool = False
    parts: tuple[PartFigure, ...] = ()
    alone: bool = False
    counted: Parts | None = field(default=None, compare=False)

    @property
    def n_seeds(self) -> int:
        return self.over_seeds.n_seeds

    @property
    def percent(self) -> float:
        return 100 * self.over_seeds.mean

    @property
    def spread(self) -> float | None:
        """The standard deviation between several seeds, in percent; None of one run."""
        spread = self.over_seeds.spread
        return None if spread is None else 100 * spread

    @property
    def low(self) -> float:
        return 100 * self.interval[0]

    @property
    def high(self) -> float:
        return 100 * self.interval[1]

    @property
    def reach(self) -> float:
        """How far the interval goes to either side at most, in percentage points: what ± says."""
        return reach_of(self.percent, self.low, self.high)


def figure_of(
    scores: Sequence[Evaluation],
    measure: Measure,
    published: float | None = None,
    known: Sequence[Evaluation] | None = None,
) -> AccuracyFigure:
    """Return the figure over ``scores``, one per seed and at least one.

    ``known`` are the scores on known forms, one per seed, where the split is by form; none where they
    were not held out. It is None for other splits.
    """
    shares = [share_of(score, measure) for score in scores]
    if known:
        return _by_form(scores, known, measure, published)
    interval, counted = _interval([scores], measure)
    note = _note(scores, measure, interval)
    alone = known is not None
    if alone:
        note += "; on unseen forms alone: train again for the accuracy on known ones"
    return AccuracyFigure(
        measure, over_seeds(shares), interval, note, published, alone=alone, counted=counted
    )


def _by_form(
    scores: Sequence[Evaluation],
    known: Sequence[Evaluation],
    measure: Measure,
    published: float | None,
) -> AccuracyFigure:
    sides = [[share_of(score, measure) for score in part] for part in (scores, known)]
    means = [harmonic_mean(*each) for each in zip(*sides, strict=True)]
    interval, counted = _interval([scores, known], measure)
    parts = []
    for label, of, shares in zip((UNSEEN, KNOWN_FORMS), (scores, known), sides, strict=True):
        (low, high), _ = _interval([of], measure)
        parts.append(PartFigure(label, 100 * fmean(shares), 100 * low, 100 * high))
    told = " and ".join(f"{part.percent:.1f} on {part.label} forms" for part in parts)
    note = f"Harmonic mean of {told}; {_interval_in_words(interval)}{_seeds_in_words(means)}"
    return AccuracyFigure(
        measure, over_seeds(means), interval, note, published, parts=tuple(parts), counted=counted
    )


def _interval(
    parts: Sequence[Sequence[Evaluation]], measure: Measure
) -> tuple[tuple[float, float], Parts | None]:
    return interval_of_scores(
        [[score.outcomes for score in part] for part in parts],
        [[interval_of(score, measure) for score in part] for part in parts],
        measure.counted,
    )


def _note(scores: Sequence[Evaluation], measure: Measure, interval: tuple[float, float]) -> str:
    if len(scores) == 1:
        word = "exact" if measure is Measure.EXACT else measure.in_words
        right = count_of(scores[0], measure)
        return f"{right} of {scores[0].count} {word}; {_interval_in_words(interval)}"
    note = f"Mean of {len(scores)} seeds"
    if measure is not Measure.EXACT:
        note = f"{measure.in_words.capitalize()}: mean of {len(scores)} seeds"
    shares = [share_of(score, measure) for score in scores]
    return f"{note}; {_interval_in_words(interval)}{_seeds_in_words(shares)}"


def _interval_in_words(interval: tuple[float, float]) -> str:
    low, high = interval
    return f"95 % interval {100 * low:.1f}–{100 * high:.1f}"


def _seeds_in_words(shares: Sequence[float]) -> str:
    spread = over_seeds(shares).spread
    if spread is None:
        return ""
    return (
        f"; standard deviation between {len(shares)} seeds {100 * spread:.1f}, "
        f"from {100 * min(shares):.1f} to {100 * max(shares):.1f}"
    )
