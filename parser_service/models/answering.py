"""How a world answers where nobody names a parser, and how good its answers are.

``parser_service.serving`` writes ``Answering``, ``parser_service.results`` the evaluations.
"""

from __future__ import annotations

from django.core.validators import MaxValueValidator, MinValueValidator
from django.db import models
from django.utils import timezone

from annotations.models import Split, User, World
from annotations.models.splits import part_choices
from parser_service.models.runs import TrainingRun
from parser_service.parsers.conditions import PEOPLES

MOST_ALLOWED_WRONG = 0.5


class AnsweringOrder(models.TextChoices):
    """Which parts of the answerer are asked, the first one first."""

    BOTH = "both", "the grammar oracle, then the learned parser"
    ORACLE = "oracle", "the grammar oracle alone"
    LEARNED = "learned", "the learned parser alone"


def answering_order_choices() -> list[tuple[str, str]]:
    return AnsweringOrder.choices


class Answering(models.Model):
    """The choices of one world. A world without a row has the defaults (``answering_of``).

    ``allowed_wrong`` is the share of wrong ones that is allowed among what is acted on, a fraction of 1.
    ``asks_language_model``: what no part of the order understands is sent to the configured language model.
    """

    world = models.OneToOneField(World, on_delete=models.CASCADE, related_name="answering")
    order = models.CharField(
        max_length=8, choices=answering_order_choices, default=AnsweringOrder.BOTH
    )
    allowed_wrong = models.FloatField(
        default=0.02, validators=[MinValueValidator(0.0), MaxValueValidator(MOST_ALLOWED_WRONG)]
    )
    asks_language_model = models.BooleanField(default=False)
    version = models.PositiveIntegerField(default=1)
    changed_by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")
    changed_at = models.DateTimeField(default=timezone.now)

    class Meta:
        verbose_name_plural = "answering"

    def __str__(self) -> str:
        return f"Answering of {self.world}"


def answering_of(world: World) -> Answering:
    """Return the choices of ``world``; the defaults, not stored, where nobody has made any."""
    return Answering.objects.filter(world=world).first() or Answering(world=world)


class AnswererEvaluationQuerySet(models.QuerySet["AnswererEvaluation"]):
    def calibrating(self) -> AnswererEvaluationQuerySet:
        """Return those whose answers the calibration was fitted to."""
        return self.filter(part="validation", test_source__in=PEOPLES)

    def newest(self) -> AnswererEvaluationQuerySet:
        """Return those of the newest measurement among these, which were all made at one moment."""
        newest = self.order_by("-made_at").values("made_at")[:1]
        return self.filter(made_at=models.Subquery(newest))


class AnswererEvaluation(models.Model):
    """What a world's answerer gave on one of ``TEST_SOURCES`` of one part of a split.

    ``run`` is that of the learned part, None where none was asked. ``correct`` counts exact matches, ``same_plan``
    those with the plan that was meant, whatever is decided. ``acted``, ``confirmed``, ``asked`` and ``refused`` sum to
    ``count``; ``wrong_acts`` and ``confirmed_right`` are among them. ``intervals``: figure → the ends of its 95 %
    interval, fractions of 1 (``parser_service.results.answerer_figures.FIGURES``).

    ``calibration`` has the weights, how many utterances of people they were fitted to, which run was the last part and
    how many of them it answered, the operating point, and the share of wrong acts that was allowed. ``answers`` are
    [probability, has the same plan, decision], the probability from a calibration without the cluster of the example,
    None where nothing was understood. ``brier`` is the Brier score of these probabilities, ``brier_before`` that of
    what the parts say themselves; None where nothing was answered. ``seconds`` are of processor time for one answer.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="answerer_evaluations")
    split = models.ForeignKey(Split, on_delete=models.CASCADE, related_name="answerer_evaluations")
    run = models.ForeignKey(
        TrainingRun, null=True, on_delete=models.CASCADE, related_name="answerer_evaluations"
    )
    order = models.CharField(max_length=8, choices=answering_order_choices)
    part = models.CharField(max_length=12, choices=part_choices)
    test_source = models.CharField(max_length=8)
    count = models.PositiveIntegerField()
    correct = models.PositiveIntegerField()
    same_plan = models.PositiveIntegerField()
    acted = models.PositiveIntegerField()
    wrong_acts = models.PositiveIntegerField()
    confirmed = models.PositiveIntegerField()
    confirmed_right = models.PositiveIntegerField()
    asked = models.PositiveIntegerField()
    refused = models.PositiveIntegerField()
    intervals = models.JSONField(default=dict)
    brier = models.FloatField(null=True)
    brier_before = models.FloatField(null=True)
    calibration = models.JSONField(default=dict)
    answers = models.JSONField(default=list)
    revision = models.PositiveIntegerField()
    seconds = models.FloatField()
    made_at = models.DateTimeField(default=timezone.now)

    objects = AnswererEvaluationQuerySet.as_manager()

    class Meta:
        ordering = ["-made_at", "part", "test_source"]
        indexes = [models.Index(fields=["world", "split", "-made_at"])]

    def __str__(self) -> str:
        return f"Answerer of {self.world} on {self.test_source} {self.part}"
