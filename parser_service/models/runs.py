"""Training runs. ``parser_service.lifecycle`` alone writes a run's status."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from django.db import models
from django.utils import timezone

from annotations.models import Split, User, World
from annotations.models.splits import Source
from parser_service.parsers.registry import PARSERS, config_fields

if TYPE_CHECKING:
    from parser_service.models.predictions import Evaluation


class Status(models.TextChoices):
    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"
    LOST = "lost"


class Protocol(models.TextChoices):
    """What training may know beside its pairs (DESIGN §5)."""

    STRICT = "strict"
    DOMAIN = "domain"
    GRAMMAR = "grammar"


class Queue(models.TextChoices):
    CPU = "cpu"
    GPU = "gpu"


class TrainSources(models.TextChoices):
    """Which examples a parser learns from: generated commands, paraphrases, or both."""

    GENERATED = "gen"
    PARAPHRASED = "para"
    BOTH = "gen+para"

    @property
    def sources(self) -> tuple[str, ...]:
        """The values of ``Example.source`` that this stands for."""
        return SOURCES[self]


SOURCES = {
    TrainSources.GENERATED: (Source.GENERATED,),
    TrainSources.PARAPHRASED: (Source.PARAPHRASED,),
    TrainSources.BOTH: (Source.GENERATED, Source.PARAPHRASED),
}


ENDED = (Status.SUCCEEDED, Status.FAILED, Status.CANCELLED, Status.LOST)


# What runs that differ by their seed have in common, beside the configuration.
SHARED_BY_SEEDS = ("world_id", "split_id", "parser", "parser_version", "protocol", "train_sources")


def status_choices() -> list[tuple[str, str]]:
    return Status.choices


def protocol_choices() -> list[tuple[str, str]]:
    return Protocol.choices


def queue_choices() -> list[tuple[str, str]]:
    return Queue.choices


class TrainingRunQuerySet(models.QuerySet["TrainingRun"]):
    def queued(self) -> TrainingRunQuerySet:
        return self.filter(status=Status.QUEUED)

    def running(self) -> TrainingRunQuerySet:
        return self.filter(status=Status.RUNNING)

    def succeeded(self) -> TrainingRunQuerySet:
        return self.filter(status=Status.SUCCEEDED)

    def active(self) -> TrainingRunQuerySet:
        return self.exclude(status__in=ENDED)

    def scored_or_active(self) -> TrainingRunQuerySet:
        """What an accuracy table shows, or will."""
        return self.exclude(status__in=[Status.FAILED, Status.CANCELLED, Status.LOST])

    def seeds_of(self, run: TrainingRun) -> TrainingRunQuerySet:
        """``run`` and those that differ from it by nothing but the seed: a cell of the accuracy table.

        Configurations are compared as the table compares them; the keys come with a query of their own.
        """
        alike = self.filter(**{name: getattr(run, name) for name in SHARED_BY_SEEDS})
        changes = run.changed_hyperparameters()
        rows = alike.select_related(None).prefetch_related(None).only("world", "parser", "config")
        keys = [row.pk for row in rows if row.changed_hyperparameters() == changes]
        return self.filter(pk__in=keys)

    def for_table(self) -> TrainingRunQuerySet:
        """With what a row of a list shows of each run: its split, who asked, its scores."""
        return self.select_related("split", "created_by").prefetch_related("evaluations")

    def expired(self) -> TrainingRunQuerySet:
        """Running rows whose worker has not extended its lease."""
        return self.running().filter(lease_until__lt=timezone.now())


class TrainingRun(models.Model):
    """One parser trained once. ``attempt`` is the fencing token of whoever runs it now; ``resumes``
    counts how often a worker was lost with it (a worker that stops in good order does not count).

    ``train_sources`` is ``gen``, ``para`` or ``gen+para``. ``content_key`` hashes all that decides the
    result; a second request for the same is answered with this row.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="runs")
    split = models.ForeignKey(Split, on_delete=models.CASCADE, related_name="runs")
    parser = models.CharField(max_length=60)
    parser_version = models.PositiveIntegerField()
    config = models.JSONField(default=dict)
    protocol = models.CharField(max_length=12, choices=protocol_choices)
    train_sources = models.CharField(max_length=12)
    seed = models.PositiveBigIntegerField(default=0)
    queue = models.CharField(max_length=8, choices=queue_choices, default=Queue.CPU)
    content_key = models.CharField(max_length=64)

    status = models.CharField(max_length=12, choices=status_choices, default=Status.QUEUED)
    attempt = models.PositiveIntegerField(default=0)
    resumes = models.PositiveSmallIntegerField(default=0)
    lease_until = models.DateTimeField(null=True, blank=True)
    worker = models.CharField(max_length=200, blank=True)
    cancel_requested = models.BooleanField(default=False)
    progress = models.FloatField(default=0)
    activity = models.CharField(max_length=200, blank=True)
    failure = models.TextField(blank=True)
    parameters = models.PositiveBigIntegerField(null=True, blank=True)
    seconds_trained = models.FloatField(default=0)

    created_by = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    queued_at = models.DateTimeField(default=timezone.now)
    started_at = models.DateTimeField(null=True, blank=True)
    finished_at = models.DateTimeField(null=True, blank=True)

    objects = TrainingRunQuerySet.as_manager()

    class Meta:
        ordering = ["-id"]
        indexes = [
            models.Index(fields=["status", "queue", "queued_at"]),
            models.Index(fields=["world", "-id"]),
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
    def is_ended(self) -> bool:
        return self.status in ENDED

    @property
    def progress_percent(self) -> float:
        return 100 * self.progress

    @property
    def scores_shown(self) -> dict[str, Evaluation]:
        """Test source → the score on the test part, or on validation where there is no test part."""
        found = sorted(self.evaluations.all(), key=lambda each: each.part == "test")
        return {each.test_source: each for each in found}

    def changed_hyperparameters(self) -> tuple[tuple[str, Any], ...]:
        """Name and value of each hyperparameter that is not the parser's default, in order."""
        if self.parser not in PARSERS:
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
