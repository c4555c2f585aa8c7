"""What workers carry out: what all such work has in common, and the jobs of a world.

``annotations.background`` alone writes the columns of work, and ``annotations.background`` the jobs.
"""

from __future__ import annotations

from datetime import timedelta
from typing import Any, ClassVar, Self, TypeVar

from django.conf import settings
from django.db import models
from django.db.models.functions import Now
from django.utils import timezone

from annotations.models.people import User
from annotations.models.short_texts import ShortTextField
from annotations.models.worlds import Duty, World

LEASE = timedelta(seconds=45 / settings.WORK_TEMPO)

# Before a minute, or a twentieth of the work, the progress says little about the time that is left.
LEAST_SECONDS = 60
LEAST_PROGRESS = 0.05


class Status(models.TextChoices):
    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"
    LOST = "lost"


ACTIVE = (Status.QUEUED, Status.RUNNING)
ENDED = (Status.SUCCEEDED, Status.FAILED, Status.CANCELLED, Status.LOST)


class Queue(models.TextChoices):
    """Which worker takes it: one that trains on the processor or on a GPU, or the one for short work."""

    CPU = "cpu"
    GPU = "gpu"
    QUICK = "quick"


def status_choices() -> list[tuple[str, str]]:
    return Status.choices


def queue_choices() -> list[tuple[str, str]]:
    return Queue.choices


Work = TypeVar("Work", bound="BackgroundWork", covariant=True)


class WorkQuerySet(models.QuerySet[Work]):
    """Named sets of background work. A kind's own query set extends it."""

    def queued(self) -> Self:
        return self.filter(status=Status.QUEUED)

    def running(self) -> Self:
        return self.filter(status=Status.RUNNING)

    def succeeded(self) -> Self:
        return self.filter(status=Status.SUCCEEDED)

    def active(self) -> Self:
        """Return what is queued or running."""
        return self.filter(status__in=ACTIVE)

    def expired(self) -> Self:
        """Return the running rows whose worker has not extended its lease, by the database's clock.

        A lease that ends far ahead is from before that clock was set back.
        """
        is_over = models.Q(lease_until__lt=Now()) | models.Q(lease_until__gt=Now() + 2 * LEASE)
        return self.running().filter(is_over)


class BackgroundWork(models.Model):
    """One piece of work. ``attempt`` is the fencing token of whoever carries it out now; ``resumes``
    counts how often a worker was lost with it (a worker that stops in good order does not count).

    ``noun`` is what messages call it; ``resumption`` what happens to it after an interruption;
    ``carried_out_by`` the dotted path of a function ``(work, give_up)``, loaded in a worker's child only.
    """

    noun: ClassVar[str] = "job"
    resumption: ClassVar[str] = "starting over"
    carried_out_by: ClassVar[str]

    queue = models.CharField(max_length=8, choices=queue_choices, default=Queue.CPU)
    status = models.CharField(max_length=12, choices=status_choices, default=Status.QUEUED)
    attempt = models.PositiveIntegerField(default=0)
    resumes = models.PositiveSmallIntegerField(default=0)
    lease_until = models.DateTimeField(null=True, blank=True)
    worker = ShortTextField(max_length=200, blank=True)
    cancel_requested = models.BooleanField(default=False)
    progress = models.FloatField(default=0)
    activity = ShortTextField(max_length=200, blank=True)
    failure = models.TextField(blank=True)
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL
    )
    queued_at = models.DateTimeField(default=timezone.now)
    started_at = models.DateTimeField(null=True, blank=True)
    finished_at = models.DateTimeField(null=True, blank=True)

    objects = WorkQuerySet.as_manager()

    class Meta:
        abstract = True

    def __str__(self) -> str:
        return f"{self.noun} {self.pk}"

    @property
    def is_ended(self) -> bool:
        return self.status in ENDED

    @property
    def progress_percent(self) -> float:
        return 100 * self.progress

    @property
    def seconds_left(self) -> float | None:
        """Estimate the seconds that running work still needs, by its progress so far.

        None where that says nothing: too early, or after an interruption, whose length nobody knows.
        """
        if self.status != Status.RUNNING or self.started_at is None or self.attempt > 1:
            return None
        passed = (timezone.now() - self.started_at).total_seconds()
        if passed < LEAST_SECONDS or self.progress < LEAST_PROGRESS:
            return None
        return passed * (1 - self.progress) / self.progress

    def note(self, message: str) -> None:
        """Add a line to the log of this work. A kind that keeps no log drops it."""


def rows_of(model: type[Work]) -> WorkQuerySet[Work]:
    """Return all rows of one kind of work."""
    rows: WorkQuerySet[Any] = model.objects.all()
    return rows


class JobKind(models.TextChoices):
    IMPORT_GENERATOR = "import_generator", "Import of generator files"
    IMPORT_COMPETITION = "import_competition", "Import of a competition folder"
    IMPORT_PAIRS = "import_pairs", "Import of published pairs"
    IMPORT_WORLD = "import_world", "Import of a world"
    LOAD_WORLD = "load_world", "Loading of a world"
    GENERATE = "generate", "Generation of commands"
    FREEZE = "freeze", "Freezing of a split"
    TRAIN = "train", "Training on the world of today"
    LAUNCH = "launch", "Launch of a campaign"
    PROPOSE = "propose", "Forms proposed by a parser"
    AUDIT = "audit", "Label audit"
    ANALYSE = "analyse", "Error analysis of a run"
    ANSWER = "answer", "Answers of runs to a text"
    MEASURE = "measure", "Measurement of what a robot gets"
    PARSE = "parse", "Parse of a batch"
    IMPORT_RESULTS = "import_results", "Import of crowd results"
    PARAPHRASE = "paraphrase", "Paraphrases by a language model"
    DELETE_WORLD = "delete_world", "Deletion of a world"


# What somebody must be allowed to do to ask for a job, or to stop it; everything else is for admins.
DUTIES = {
    JobKind.GENERATE: Duty.ANNOTATE,
    JobKind.FREEZE: Duty.ANNOTATE,
    JobKind.PROPOSE: Duty.ANNOTATE,
    JobKind.AUDIT: Duty.REVIEW,
    JobKind.ANALYSE: Duty.REVIEW,
    JobKind.MEASURE: Duty.REVIEW,
    JobKind.ANSWER: Duty.VIEW,
    JobKind.PARSE: Duty.VIEW,
}


def job_kind_choices() -> list[tuple[str, str]]:
    return JobKind.choices


class JobQuerySet(WorkQuerySet["Job"]):
    def visible_to(self, user: User) -> JobQuerySet:
        """Return the jobs of worlds that ``user`` sees, and their own; all for an administrator of the site."""
        if user.is_superuser:
            return self
        of_worlds = models.Q(world__in=World.objects.visible_to(user))
        return self.filter(of_worlds | models.Q(created_by=user))

    def needing_attention(self) -> JobQuerySet:
        """Return the jobs that wait for an answer, and those that wait or run."""
        is_asking = models.Q(status=Status.SUCCEEDED, report__is_waiting=True)
        return self.filter(is_asking | models.Q(status__in=ACTIVE))


class Job(BackgroundWork):
    """One verb on one world. ``report`` is what the verb reports, as JSON; None until it has ended.

    ``world`` is None while the world does not exist yet, or no longer; its name is ``world_name``.
    ``arguments`` are those of the verb; with ``files``, the names of the uploads that are kept until
    the job has ended, or until somebody has answered the question that its report asks.
    """

    carried_out_by: ClassVar[str] = "annotations.background.carrying_out_jobs.carry_out"

    world = models.ForeignKey(
        World, null=True, blank=True, on_delete=models.CASCADE, related_name="jobs"
    )
    world_name = models.CharField(max_length=60)
    kind = models.CharField(max_length=20, choices=job_kind_choices)
    arguments = models.JSONField(default=dict, blank=True)
    report = models.JSONField(null=True, blank=True)

    objects = JobQuerySet.as_manager()  # type: ignore[misc]  # of the class, as that of the base is

    class Meta:
        ordering = ["-id"]
        indexes = [
            models.Index(fields=["status", "queue", "queued_at"]),
            models.Index(fields=["world", "-id"]),
            models.Index(fields=["world", "kind", "-id"], name="jobs_of_kind"),
            models.Index(fields=["world", "finished_at"], name="ended_jobs"),
        ]

    @property
    def title(self) -> str:
        """What the job does, in words: of an error analysis also of which run."""
        run = self.arguments.get("run") if self.kind == JobKind.ANALYSE else None
        return f"Error analysis of run {run}" if run else self.get_kind_display()

    @property
    def duty(self) -> Duty:
        """What somebody must be allowed to do to ask for such a job, or to stop it."""
        return DUTIES.get(JobKind(self.kind), Duty.MANAGE)

    @property
    def is_waiting_for_answer(self) -> bool:
        """Whether it has stopped before an import that somebody has to confirm, and asks."""
        is_asking = bool(self.report and self.report.get("is_waiting"))
        return is_asking and self.status == Status.SUCCEEDED
