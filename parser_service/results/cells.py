"""One cell of an accuracy table: the score of one run, or mean and spread over seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from parser_service.analysis.seeds import OverSeeds, over_seeds
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.runs import Status


@dataclass(frozen=True)
class Cell:
    """A parser in a column: its scores, one per seed, newest first, or the runs that will have some.

    ``published`` is the paper's figure in percent. Percentages are None before there is a score.
    """

    scores: tuple[Evaluation, ...]
    active: tuple[TrainingRun, ...]
    published: float | None
    url: str
    is_best: bool = False

    @property
    def score(self) -> Evaluation | None:
        """The newest score."""
        return self.scores[0] if self.scores else None

    @cached_property
    def over_seeds(self) -> OverSeeds | None:
        return over_seeds([score.accuracy for score in self.scores]) if self.scores else None

    @property
    def n_seeds(self) -> int:
        return len(self.scores)

    @property
    def percent(self) -> float | None:
        return 100 * self.over_seeds.mean if self.over_seeds else None

    @property
    def spread(self) -> float | None:
        """The standard deviation between several seeds, in percent; None of one run."""
        spread = self.over_seeds.spread if self.over_seeds else None
        return None if spread is None else 100 * spread

    @property
    def low(self) -> float | None:
        """The lower end of one run's interval; of several the worst of them."""
        return 100 * min(_low(self.scores)) if self.scores else None

    @property
    def high(self) -> float | None:
        """The upper end of one run's interval; of several the best of them."""
        return 100 * max(_high(self.scores)) if self.scores else None

    @property
    def note(self) -> str:
        """What the figure means, for its tooltip."""
        if not self.score:
            return ""
        waiting = f"; {len(self.active)} more on the way" if self.active else ""
        return f"{self._what}{waiting}"

    @property
    def _what(self) -> str:
        span = f"{self.low:.1f}–{self.high:.1f}"
        if self.n_seeds > 1:
            return f"Mean of {self.n_seeds} seeds ± standard deviation, from {span}"
        return f"{self.score.correct} of {self.score.count} exact; 95 % interval {span}"

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


def _low(scores: Sequence[Evaluation]) -> list[float]:
    return [score.accuracy if len(scores) > 1 else score.interval_low for score in scores]


def _high(scores: Sequence[Evaluation]) -> list[float]:
    return [score.accuracy if len(scores) > 1 else score.interval_high for score in scores]


def newest_of_each_seed(runs: Sequence[TrainingRun]) -> list[TrainingRun]:
    """Return the runs to take a mean over: for each seed the newest, of the newest run's parser version.

    ``runs`` come newest first. (The world may have been edited since an older run of a seed.)
    """
    by_seed: dict[int, TrainingRun] = {}
    for run in runs:
        if run.parser_version == runs[0].parser_version:
            by_seed.setdefault(run.seed, run)
    return list(by_seed.values())
