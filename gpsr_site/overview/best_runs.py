"""The most accurate run of each protocol on one split."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from django.db.models import BooleanField, ExpressionWrapper, Q
from django.urls import reverse
from django.utils.http import urlencode

from annotations.language.corpus import KNOWN, Criterion
from annotations.models import Split, World
from annotations.models.background import Status
from parser_service.models import Evaluation
from parser_service.models.evaluations import ShownScore, shown_scores
from parser_service.parsers.conditions import Protocol, in_words, only_source
from parser_service.parsers.registry import PARSERS

PART = "validation"
# The harder source first: people say things as no grammar does.
SOURCES = ("para", "said", "gen", "model", "mixed")  # the first that is tested counts


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
        entry = PARSERS.get(self.parser)
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
    """The best of each protocol on ``split``. Protocols are not compared with each other."""

    split: Split
    source: str
    runs: tuple[BestRun, ...]


def best_runs(world: World) -> BestRuns | None:
    """Find the best runs on the validation part of a split, on paraphrases where it has any.

    The split is the one that was scored last. One by logical form is taken only if there is no other, because
    most parsers cannot answer a form that training never showed. The best run there has the highest harmonic
    mean of unseen and known forms. Two queries; None if nothing has been scored.
    """
    scores = Evaluation.objects.filter(
        run__world=world,
        run__status=Status.SUCCEEDED,
        run__train_share=1,
        part__in=[PART, KNOWN],
        count__gt=0,
    )
    is_by_form = Q(run__split__criterion=Criterion.LOGICAL_FORM)
    order = (ExpressionWrapper(is_by_form, BooleanField()), "-run_id")
    newest = scores.filter(part=PART).select_related("run__split").order_by(*order).first()
    if newest is None:
        return None
    on_split = list(scores.filter(run__split=newest.run.split_id).select_related("run"))
    tested = {score.test_source for score in on_split if score.part == PART}
    source = next(each for each in SOURCES if each in tested)
    of_runs: dict[int, list[Evaluation]] = defaultdict(list)
    for score in on_split:
        of_runs[score.run_id].append(score)
    shown = (shown_scores(each, newest.run.split.criterion) for each in of_runs.values())
    comparable = [each[PART, source] for each in shown if (PART, source) in each]
    # The best comes last: figures on unseen forms alone come first, and the newer of two equal ones later.
    comparable.sort(key=lambda each: (not each.alone, each.accuracy, each.score.run_id))
    best = {each.score.run.protocol: each for each in comparable}
    runs = tuple(BestRun(world, best[each]) for each in Protocol if each in best)
    return BestRuns(newest.run.split, in_words(source), runs)
