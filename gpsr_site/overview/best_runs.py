"""The most accurate run of each protocol on one split."""

from __future__ import annotations

from dataclasses import dataclass

from django.urls import reverse
from django.utils.http import urlencode

from annotations.models import Split, World
from parser_service.models import Evaluation
from parser_service.models.evaluations import ShownScore
from parser_service.parsers.conditions import in_words, only_source
from parser_service.parsers.registry import parsers
from parser_service.serving.default_runs import standings


@dataclass(frozen=True, slots=True)
class BestRun:
    """A run's score on the validation part, with the address of what it got wrong."""

    world: World
    figure: ShownScore

    @property
    def score(self) -> Evaluation:
        return self.figure.score

    @property
    def protocol(self) -> str:
        return self.score.run.protocol

    @property
    def parser(self) -> str:
        return self.score.run.parser

    @property
    def title(self) -> str:
        entry = parsers().get(self.parser)
        return entry.title if entry else self.parser

    @property
    def wrong(self) -> int:
        """How many examples it did not answer exactly."""
        return self.score.count - self.score.correct

    @property
    def wrong_url(self) -> str:
        """The page that shows exactly these examples, one by one."""
        chosen: dict[str, str | int] = {
            "run": self.score.run_id,
            "part": self.score.part,
            "outcome": "wrong",
        }
        if source := only_source(self.score.test_source):
            chosen["source"] = source
        address = reverse("review", kwargs={"world": self.world.name})
        return f"{address}?{urlencode(chosen)}"

    @property
    def run_url(self) -> str:
        return reverse("run", kwargs={"world": self.world.name, "pk": self.score.run_id})


@dataclass(frozen=True, slots=True)
class BestRuns:
    """The best of each protocol on ``split``, by their order in it; what each may know is said beside it."""

    split: Split
    source: str
    runs: tuple[BestRun, ...]


def best_runs(world: World) -> BestRuns | None:
    """Find the best run of each protocol, the best one first, on the validation part of the split that pages
    open on.

    Split, source and order are those of ``parser_service.serving.default_runs``. None if nothing has been scored.
    """
    standing = next(standings(world), None)
    if standing is None:
        return None
    best: dict[str, ShownScore] = {}
    for each in standing.scores:
        best.setdefault(each.score.run.protocol, each)
    runs = tuple(BestRun(world, each) for each in best.values())
    return BestRuns(standing.split, in_words(standing.source), runs)
