"""Training runs. ``parser_service.runs.lifecycle`` alone writes a run's status, by ``annotations.background``."""

from __future__ import annotations

from typing import Any, ClassVar

from django.apps import apps
from django.db import models
from django.utils import timezone

from annotations.models import Split, World
from annotations.models.background import BackgroundWork, Status, WorkQuerySet
from annotations.models.background import status_choices as status_choices
from annotations.models.short_texts import ShortTextField
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.interface import ScoreKind
from parser_service.parsers.registry import config_fields, parsers

# What runs that differ by their seed have in common, beside the configuration.
SHARED_BY_SEEDS = (
    *("world_id", "split_id", "parser", "parser_version", "protocol"),
    *("train_sources", "train_share"),
)


def protocol_choices() -> list[tuple[str, str]]:
    return [(each.value, each.value.capitalize()) for each in Protocol]


def score_kind_choices() -> list[tuple[str, str]]:
    return [(each.value, each.value.replace("_", "-")) for each in ScoreKind]


class TrainingRunQuerySet(WorkQuerySet["TrainingRun"]):
    def scored_or_active(self) -> TrainingRunQuerySet:
        """Return the runs that an accuracy table shows or will show."""
        return self.exclude(status__in=[Status.FAILED, Status.CANCELLED, Status.LOST])

    def on_all_pairs(self) -> TrainingRunQuerySet:
        """Return the runs that learned from all training pairs, not from a share of them."""
        return self.filter(train_share=1)

    def succeeded_since(self) -> TrainingRunQuerySet:
        """Return the runs after which one of the same parser on the same split has succeeded."""
        return self.filter(models.Exists(self._later_successes()))

    def not_succeeded_since(self) -> TrainingRunQuerySet:
        """Return the others: what went wrong with them still keeps somebody from a result."""
        return self.exclude(models.Exists(self._later_successes()))

    def _later_successes(self) -> TrainingRunQuerySet:
        same = {name: models.OuterRef(name) for name in ("world", "split", "parser", "train_share")}
        return TrainingRun.objects.succeeded().filter(pk__gt=models.OuterRef("pk"), **same)

    def seeds_of(self, run: TrainingRun) -> TrainingRunQuerySet:
        """Return ``run`` and those that differ from it only by their seed: one cell of the accuracy table.

        Configurations are compared as the table compares them; the keys come with a query of their own.
        """
        alike = self.filter(**{name: getattr(run, name) for name in SHARED_BY_SEEDS})
        changes = run.changed_hyperparameters()
        rows = alike.select_related(None).prefetch_related(None).only("world", "parser", "config")
        keys = [row.pk for row in rows if row.changed_hyperparameters() == changes]
        return self.filter(pk__in=keys)

    def for_table(self) -> TrainingRunQuerySet:
        """Prefetch what a list shows of each run: its split, who requested it, its scores."""
        scores = apps.get_model("parser_service", "Evaluation").objects.defer("outcomes")
        of_each = models.Prefetch("evaluations", scores)
        return self.select_related("split", "created_by").prefetch_related(of_each)


class TrainingRun(BackgroundWork):
    """One parser trained once.

    ``train_sources`` is one of ``TRAIN_SOURCES``, such as ``gen+para``. ``train_share`` is the share of their training
    pairs that the seed draws, above 0 and up to 1, and ``train_pairs`` how many that are, None before
    the run is scored. ``answered_by`` is the model that answered, as its server reports it, empty where
    the parser answers itself. ``content_key`` hashes all that decides the result; a second request for the same
    is answered with this row. ``score_kind`` is empty where the scores of its answers only order them.
    """

    noun: ClassVar[str] = "run"
    resumption: ClassVar[str] = "resuming from the last checkpoint"
    carried_out_by: ClassVar[str] = "parser_service.runs.train_run.train"

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="runs")
    split = models.ForeignKey(Split, on_delete=models.CASCADE, related_name="runs")
    parser = models.CharField(max_length=60)
    parser_version = models.PositiveIntegerField()
    config = models.JSONField(default=dict)
    protocol = models.CharField(max_length=12, choices=protocol_choices)
    train_sources = models.CharField(max_length=24)
    train_share = models.FloatField(default=1.0)
    train_pairs = models.PositiveIntegerField(null=True, blank=True)
    seed = models.PositiveBigIntegerField(default=0)
    content_key = models.CharField(max_length=64)

    parameters = models.PositiveBigIntegerField(null=True, blank=True)
    seconds_trained = models.FloatField(default=0)
    score_kind = models.CharField(max_length=20, choices=score_kind_choices, blank=True)
    answered_by = ShortTextField(max_length=200, blank=True)

    objects = TrainingRunQuerySet.as_manager()  # type: ignore[misc]  # of the class, as that of the base is

    class Meta:
        ordering = ["-id"]
        indexes = [
            models.Index(fields=["status", "queue", "queued_at"]),
            models.Index(fields=["world", "-id"]),
            models.Index(fields=["world", "finished_at"], name="ended_runs"),
        ]
        constraints = [
            models.UniqueConstraint(
                fields=["world", "content_key"],
                condition=models.Q(status__in=["queued", "running", "succeeded"]),
                name="trained_once",
            )
        ]

    def __str__(self) -> str:
        return f"run {self.pk}: {self.parser} on {self.train_sources}"

    @property
    def share_in_words(self) -> str:
        """``25 %`` of the training pairs; empty where the run learns from all."""
        return "" if self.train_share == 1 else f"{100 * self.train_share:g} %"

    @property
    def trained_on(self) -> str:
        """What tells the run from others of its parser: ``25 % of gen+para of mine, seed 1``."""
        share = f"{self.share_in_words} of " if self.share_in_words else ""
        seed = f", seed {self.seed}" if self.seed else ""
        return f"{share}{self.train_sources} of {self.split.name}{seed}"

    def note(self, message: str) -> None:
        """Add a line to the run's log."""
        RunEvent.objects.create(run=self, attempt=self.attempt, message=message)

    def changed_hyperparameters(self) -> tuple[tuple[str, Any], ...]:
        """Return name and value of each hyperparameter that is not at the parser's default, in order."""
        if self.parser not in parsers():
            return tuple(self.config.items())
        return tuple(
            (field.name, self.config[field.name])
            for field in config_fields(self.parser)
            if self.config.get(field.name, field.default) != field.default
        )


class EpochMetric(models.Model):
    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="epochs")
    epoch = models.PositiveIntegerField()
    train_loss = models.FloatField()
    validation_loss = models.FloatField(null=True)
    validation_accuracy = models.FloatField(null=True)
    seconds = models.FloatField()

    class Meta:
        ordering = ["epoch"]
        constraints = [models.UniqueConstraint(fields=["run", "epoch"], name="epoch_once")]

    def __str__(self) -> str:
        return f"epoch {self.epoch} of run {self.run_id}"


class Checkpoint(models.Model):
    """A folder below ``GPSR_VAR_DIR``; ``sha256`` covers its files. The last and the best are kept."""

    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="checkpoints")
    epoch = models.PositiveIntegerField()
    folder = models.CharField(max_length=300)
    sha256 = models.CharField(max_length=64)
    is_best = models.BooleanField(default=False)
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["epoch"]

    def __str__(self) -> str:
        return self.folder


class RunEvent(models.Model):
    """A line of a run's log."""

    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="events")
    attempt = models.PositiveIntegerField()
    at = models.DateTimeField(default=timezone.now)
    message = models.TextField()

    class Meta:
        ordering = ["id"]

    def __str__(self) -> str:
        return self.message
