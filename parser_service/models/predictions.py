"""The answers of a run's parser to the examples of a split."""

from __future__ import annotations

from django.db import models
from django.db.models.functions import Length

from annotations.models import Example
from parser_service.models.runs import TrainingRun

models.TextField.register_lookup(Length)


OUTCOMES = {
    "correct": models.Q(is_exact_match=True),
    "wrong": models.Q(is_exact_match=False),
    "equivalent": models.Q(is_exact_match=False, is_equivalent=True),
    "same_plan": models.Q(is_same_plan=True),
    "only_plan": models.Q(is_equivalent=False, is_same_plan=True),
    "other_plan": models.Q(is_same_plan=False),
    "malformed": models.Q(is_well_formed=False) & ~models.Q(logical_form=""),
    "none": models.Q(logical_form=""),
}


class PredictionQuerySet(models.QuerySet["Prediction"]):
    def best(self) -> PredictionQuerySet:
        """Return the first-ranked prediction of each example."""
        return self.filter(rank=1)

    def with_outcome(self, outcome: str) -> PredictionQuerySet:
        """Return those with the outcome ``correct``, ``wrong``, ``equivalent`` (but not exact), ``same_plan``,
        ``only_plan`` (the same plan, but not equivalent), ``other_plan``, ``malformed`` or ``none`` (no answer).

        Where plans were not compared, an answer has neither the same plan nor another one."""
        return self.filter(OUTCOMES[outcome])


class Prediction(models.Model):
    """A ranked candidate for one example. An example without candidates has one row with an empty form.

    ``is_same_plan`` says whether the answer has the plan of the label by the recipes that the world had when
    the run was scored, or its plans were last compared; None where they were not.
    ``answer_in_training`` and ``label_in_training`` count the training pairs that have this form and the
    example's, None where it is not known and for the empty form. ``origin`` says where the parser has the
    form from: ``training`` unless the parser tells something else; ``score_parts`` says what its score is
    made of. Both are empty where that is not known. ``is_cut`` says that the parser read only the beginning of
    the utterance, which is longer than it reads.
    """

    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="predictions")
    example = models.ForeignKey(Example, on_delete=models.CASCADE, related_name="predictions")
    rank = models.PositiveSmallIntegerField()
    logical_form = models.TextField(blank=True)
    score = models.FloatField()
    is_exact_match = models.BooleanField()
    is_equivalent = models.BooleanField()
    is_well_formed = models.BooleanField()
    is_same_plan = models.BooleanField(null=True, blank=True)
    answer_in_training = models.PositiveIntegerField(null=True, blank=True)
    label_in_training = models.PositiveIntegerField(null=True, blank=True)
    origin = models.CharField(max_length=20, blank=True)
    score_parts = models.JSONField(default=dict, blank=True)
    is_cut = models.BooleanField(default=False, db_default=False)

    objects = PredictionQuerySet.as_manager()

    class Meta:
        ordering = ["run", "example", "rank"]
        constraints = [
            models.UniqueConstraint(fields=["run", "example", "rank"], name="predicted_once")
        ]
        # In the order of examples, so that a reader goes on to the next wrong answer at once.
        indexes = [
            models.Index(
                fields=["run", "rank", "is_exact_match", "example"], name="answers_in_order"
            ),
            # Narrows a search for one form down without holding the forms once more.
            models.Index(
                "run",
                "rank",
                Length("logical_form"),
                "is_exact_match",
                "example",
                name="answers_by_length",
            ),
        ]

    def __str__(self) -> str:
        return self.logical_form
