"""How often the answers of a run are right, and how pages show it: by form never that on unseen forms alone."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from django.db import models

from parser_service.models.runs import TrainingRun
from parser_service.parsers.conditions import TEST_SOURCES, only_source

if TYPE_CHECKING:
    from parser_service.analysis.clustered import Interval

UNSEEN, KNOWN_FORMS = "unseen", "known"


class EvaluationQuerySet(models.QuerySet["Evaluation"]):
    def shown_by_source(self) -> dict[str, ShownScore]:
        """Return the scores of one run by test source, in their usual order: on the test part, or on validation
        where there is no test part."""
        scores = list(self)
        if not scores:
            return {}
        by_place = shown_scores(scores, scores[0].run.split.criterion)
        test_part_last = sorted(by_place, key=lambda place: place[0] == "test")
        by_source = {place[1]: by_place[place] for place in test_part_last}
        return {source: by_source[source] for source in TEST_SOURCES if source in by_source}


class Evaluation(models.Model):
    """Exact match of one run on one of ``TEST_SOURCES`` of one part.

    Fractions of 1; the interval at 95 % is that of a bootstrap of clusters, which ``outcomes`` counts
    (``parser_service.analysis.outcomes``). ``same_plan`` is None where plans were not compared. A split by form has
    the part ``known`` too: pairs held out of the training part, whose forms stay there.
    """

    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="evaluations")
    test_source = models.CharField(max_length=8)
    part = models.CharField(max_length=12)
    count = models.PositiveIntegerField()
    correct = models.PositiveIntegerField()
    accuracy = models.FloatField()
    interval_low = models.FloatField()
    interval_high = models.FloatField()
    equivalent = models.FloatField()
    well_formed = models.FloatField()
    same_plan = models.FloatField(null=True, blank=True)
    outcomes = models.JSONField(default=dict, blank=True)

    objects = EvaluationQuerySet.as_manager()

    class Meta:
        ordering = ["run", "part", "test_source"]
        constraints = [
            models.UniqueConstraint(fields=["run", "test_source", "part"], name="evaluated_once")
        ]

    def __str__(self) -> str:
        return f"{self.run}: {self.accuracy:.3f} on {self.test_source} {self.part}"

    @property
    def source(self) -> str:
        """The source of its examples; empty where they have several."""
        return only_source(self.test_source) or ""


@dataclass(frozen=True, slots=True)
class PartFigure:
    """One of the two figures by form behind a harmonic mean, in percent, with the ends of its 95 % interval."""

    label: str
    percent: float
    low: float
    high: float

    @property
    def reach(self) -> float:
        return reach_of(self.percent, self.low, self.high)


@dataclass(frozen=True, slots=True)
class ShownScore:
    """A score on a part. By form ``known`` is that on known forms, None where they were not held out, and
    the figure is the harmonic mean of both."""

    score: Evaluation
    known: Evaluation | None = None
    is_by_form: bool = False

    @property
    def accuracy(self) -> float:
        """The figure, a fraction of 1."""
        from annotations.language.corpus import harmonic_mean

        if self.known is None:
            return self.score.accuracy
        return harmonic_mean(self.score.accuracy, self.known.accuracy)

    @property
    def percent(self) -> float:
        return 100 * self.accuracy

    @property
    def alone(self) -> bool:
        """Whether the figure is on unseen forms alone."""
        return self.is_by_form and self.known is None

    @property
    def parts(self) -> tuple[PartFigure, ...]:
        """What a harmonic mean is made of; empty of other figures."""
        if self.known is None:
            return ()
        sides = ((UNSEEN, self.score), (KNOWN_FORMS, self.known))
        return tuple(
            PartFigure(
                label, 100 * side.accuracy, 100 * side.interval_low, 100 * side.interval_high
            )
            for label, side in sides
        )

    @property
    def low(self) -> float:
        return 100 * self.interval[0]

    @property
    def high(self) -> float:
        return 100 * self.interval[1]

    @property
    def interval(self) -> Interval:
        """The 95 % interval of the figure, fractions of 1."""
        # Not before a page shows one: it needs NumPy, and whatever starts loads the models.
        from parser_service.analysis.outcomes import interval_of_scores

        sides = (self.score,) if self.known is None else (self.score, self.known)
        return interval_of_scores(
            [[each.outcomes] for each in sides],
            [[(each.interval_low, each.interval_high)] for each in sides],
        )[0]


def shown_scores(
    evaluations: Iterable[Evaluation], criterion: str
) -> dict[tuple[str, str], ShownScore]:
    """Return the scores of one run on a split by ``criterion``, by part and test source; those on known forms
    stand beside the others."""
    from annotations.language.corpus import KNOWN, Criterion

    by_place = {(each.part, each.test_source): each for each in evaluations}
    is_by_form = criterion == Criterion.LOGICAL_FORM
    return {
        (part, source): ShownScore(
            score, by_place.get((KNOWN, source)) if is_by_form else None, is_by_form
        )
        for (part, source), score in by_place.items()
        if part != KNOWN
    }


def reach_of(percent: float, low: float, high: float) -> float:
    """Return how far an interval goes to either side at most: what ± says."""
    return max(high - percent, percent - low, 0.0)
