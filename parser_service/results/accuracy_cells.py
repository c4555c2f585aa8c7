"""One cell of an accuracy table: the score of one run, or of several seeds."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from annotations.models.background import Status
from parser_service.analysis.scores import OverSeeds, over_seeds
from parser_service.models import Evaluation, TrainingRun
from parser_service.results.measures import Measure
from parser_service.results.seed_figures import AccuracyFigure

PLANS_NOT_COMPARED = "The plans of these answers were not compared: analyse the run again"


@dataclass(frozen=True)
class Cell:
    """A parser in a column: its scores, one per seed, newest first, or the runs that will have some.

    ``figures`` are by the ``measures`` that the table shows; none before there is a score, and None by a measure
    that is not known of each score. ``published`` is
    the paper's figure in percent, whether it is shown or not. ``answered_by`` names the models behind the
    scores, as their servers report them.
    """

    scores: tuple[Evaluation, ...]
    active: tuple[TrainingRun, ...]
    published: float | None
    url: str
    figures: tuple[AccuracyFigure | None, ...] = ()
    answered_by: str = ""
    measures: tuple[Measure, ...] = ()

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
    def by_measure(self) -> list[tuple[Measure, AccuracyFigure | None]]:
        """Each measure with its figure; none before there is a score."""
        return list(zip(self.measures, self.figures, strict=False))

    @property
    def first(self) -> AccuracyFigure | None:
        """The first of its figures; None where it is not known, or there is none."""
        return self.figures[0] if self.figures else None

    @property
    def percent(self) -> float | None:
        return self.first.percent if self.first else None

    @property
    def spread(self) -> float | None:
        return self.first.spread if self.first else None

    @property
    def low(self) -> float | None:
        return self.first.low if self.first else None

    @property
    def high(self) -> float | None:
        return self.first.high if self.first else None

    @property
    def is_best(self) -> bool:
        """Whether the first of its figures is better than every other one of its column, beyond chance."""
        return self.first is not None and self.first.is_best

    @property
    def note(self) -> str:
        """What the figures mean, for a tooltip."""
        if not self.figures:
            return ""
        waiting = f"; {len(self.active)} more on the way" if self.active else ""
        best = "; better than every other one of this column" if self.is_best else ""
        model = f"; answered by {self.answered_by}" if self.answered_by else ""
        notes = (figure.note if figure else PLANS_NOT_COMPARED for figure in self.figures)
        return "; ".join(notes) + waiting + best + model

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

    def mark_best(self, measures: Collection[int]) -> Cell:
        """Return the cell with the figures at these places marked as the best of their column."""
        marked = tuple(
            figure and replace(figure, is_best=at in measures)
            for at, figure in enumerate(self.figures)
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
