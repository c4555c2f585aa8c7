"""One cell of an accuracy table: the score of one run, or mean and spread over seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parser_service.analysis.seeds import OverSeeds, over_seeds
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.runs import Status
from parser_service.results.measures import Measure, count_of, interval_of, share_of


@dataclass(frozen=True, slots=True)
class Figure:
    """What a cell says by one measure.

    ``interval``, fractions of 1, is the 95 % interval of one run; of several seeds it goes from the
    worst to the best. ``note`` says what the figure means; ``published`` is the paper's figure in
    percent where it is to be shown.
    """

    measure: Measure
    over_seeds: OverSeeds
    interval: tuple[float, float]
    note: str
    published: float | None = None
    is_best: bool = False

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


def figure_of(
    scores: Sequence[Evaluation], measure: Measure, published: float | None = None
) -> Figure:
    """Return the figure over ``scores``, one per seed, of which there is at least one."""
    shares = [share_of(score, measure) for score in scores]
    is_one = len(scores) == 1
    low, high = interval_of(scores[0], measure) if is_one else (min(shares), max(shares))
    span = f"{100 * low:.1f}–{100 * high:.1f}"
    if is_one:
        right = count_of(scores[0], measure)
        word = "exact" if measure is Measure.EXACT else measure.in_words
        note = f"{right} of {scores[0].count} {word}; 95 % interval {span}"
    else:
        note = f"Mean of {len(scores)} seeds ± standard deviation, from {span}"
        if measure is not Measure.EXACT:
            note = f"{measure.in_words.capitalize()}: {note[0].lower()}{note[1:]}"
    return Figure(measure, over_seeds(shares), (low, high), note, published)


@dataclass(frozen=True)
class Cell:
    """A parser in a column: its scores, one per seed, newest first, or the runs that will have some.

    ``figures`` are by the measures that the table shows; none before there is a score. ``published`` is
    the paper's figure in percent, whether it is shown or not.
    """

    scores: tuple[Evaluation, ...]
    active: tuple[TrainingRun, ...]
    published: float | None
    url: str
    figures: tuple[Figure, ...] = ()

    @property
    def score(self) -> Evaluation | None:
        """The newest score."""
        return self.scores[0] if self.scores else None

    @property
    def over_seeds(self) -> OverSeeds | None:
        """Mean and spread of exact match."""
        return over_seeds([score.accuracy for score in self.scores]) if self.scores else None

    @property
    def n_seeds(self) -> int:
        return len(self.scores)

    @property
    def percent(self) -> float | None:
        return self.figures[0].percent if self.figures else None

    @property
    def spread(self) -> float | None:
        return self.figures[0].spread if self.figures else None

    @property
    def low(self) -> float | None:
        return self.figures[0].low if self.figures else None

    @property
    def high(self) -> float | None:
        return self.figures[0].high if self.figures else None

    @property
    def is_best(self) -> bool:
        """Whether the first of its figures is the best of its column."""
        return bool(self.figures) and self.figures[0].is_best

    @property
    def note(self) -> str:
        """What the figures mean, for a tooltip."""
        if not self.figures:
            return ""
        waiting = f"; {len(self.active)} more on the way" if self.active else ""
        best = "; the best of this column" if self.is_best else ""
        return "; ".join(figure.note for figure in self.figures) + waiting + best

    @property
    def status(self) -> str:
        """``running`` if one of the active runs is running, else ``queued``; empty without any."""
        is_running = any(run.status == Status.RUNNING for run in self.active)
        return Status.RUNNING if is_running else Status.QUEUED if self.active else ""

    @property
    def progress_percent(self) -> float:
        """The mean progress of the active runs."""
        done = sum(run.progress for run in self.active)
        return 100 * done / len(self.active) if self.active else 0

    def mark_best(self, best: Sequence[float]) -> Cell:
        """Return the cell with the figures marked whose mean is that of ``best``, one per measure; 0 is
        never the best."""
        marked = tuple(
            replace(figure, is_best=figure.over_seeds.mean == top > 0)
            for figure, top in zip(self.figures, best, strict=False)
        )
        return replace(self, figures=marked)


def newest_of_each_seed(runs: Sequence[TrainingRun]) -> list[TrainingRun]:
    """Return the runs to take a mean over: for each seed the newest, of the newest run's parser version.

    ``runs`` come newest first. (The world may have been edited since an older run of a seed.)
    """
    by_seed: dict[int, TrainingRun] = {}
    for run in runs:
        if run.parser_version == runs[0].parser_version:
            by_seed.setdefault(run.seed, run)
    return list(by_seed.values())
