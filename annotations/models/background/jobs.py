"""Imports, generation and deletion that a worker carries out. ``annotations.jobs`` alone writes them."""

from __future__ import annotations

from typing import ClassVar

from django.db import models

from annotations.models.background.work import (
    ENDED,
    BackgroundWork,
    Status,
    WorkQuerySet,
)
from annotations.models.people import User
from annotations.models.worlds import Duty, World


class JobKind(models.TextChoices):
    IMPORT_GENERATOR = "import_generator", "Import of generator files"
    IMPORT_PAIRS = "import_pairs", "Import of published pairs"
    IMPORT_WORLD = "import_world", "Import of a world"
    GENERATE = "generate", "Generation of commands"
    PROPOSE = "propose", "Forms proposed by a parser"
    AUDIT = "audit", "Label audit"
    ANALYSE = "analyse", "Error analysis of a run"
    ANSWER = "answer", "Answers of runs to a text"
    DELETE_WORLD = "delete_world", "Deletion of a world"


# What somebody must be allowed to do to ask for a job, or to stop it; everything else is for admins.
DUTIES = {
    JobKind.GENERATE: Duty.ANNOTATE,
    JobKind.PROPOSE: Duty.ANNOTATE,
    JobKind.AUDIT: Duty.REVIEW,
    JobKind.ANALYSE: Duty.REVIEW,
    JobKind.ANSWER: Duty.VIEW,
}


def job_kind_choices() -> list[tuple[str, str]]:
    return JobKind.choices


class JobQuerySet(WorkQuerySet):
    def visible_to(self, user: User) -> JobQuerySet:
        """Return the jobs of worlds that ``user`` sees, and their own; all for an administrator of the site."""
        if user.is_superuser:
            return self
        of_worlds = models.Q(world__in=World.objects.visible_to(user))
        return self.filter(of_worlds | models.Q(created_by=user))

    def needing_attention(self) -> JobQuerySet:
        """Return the jobs that wait for an answer, and those that wait or run."""
        is_asking = models.Q(status=Status.SUCCEEDED, report__is_waiting=True)
        return self.filter(is_asking | ~models.Q(status__in=ENDED))


class Job(BackgroundWork):
    """One verb on one world. ``report`` is what the verb reports, as JSON; None until it has ended.

    ``world`` is None while the world does not exist yet, or no longer; its name is ``world_name``.
    ``arguments`` are those of the verb; with ``files``, the names of the uploads that are kept until
    the job has ended, or until somebody has answered the question that its report asks.
    """

    noun: ClassVar[str] = "job"
    resumption: ClassVar[str] = "starting over"

    world = models.ForeignKey(
        World, null=True, blank=True, on_delete=models.CASCADE, related_name="jobs"
    )
    world_name = models.CharField(max_length=60)
    kind = models.CharField(max_length=20, choices=job_kind_choices)
    arguments = models.JSONField(default=dict, blank=True)
    report = models.JSONField(null=True, blank=True)

    objects = JobQuerySet.as_manager()

    @property
    def title(self) -> str:
        """What the job does, in words: of an error analysis also of which run."""
        run = self.arguments.get("run") if self.kind == JobKind.ANALYSE else None
        return f"Error analysis of run {run}" if run else self.get_kind_display()

    class Meta:
        ordering = ["-id"]
        indexes = [
            models.Index(fields=["status", "queue", "queued_at"]),
            models.Index(fields=["world", "-id"]),
        ]

    @property
    def duty(self) -> Duty:
        """What somebody must be allowed to do to ask for such a job, or to stop it."""
        return DUTIES.get(JobKind(self.kind), Duty.MANAGE)

    @property
    def is_waiting_for_answer(self) -> bool:
        """Whether it has stopped before an import that would remove something, and asks."""
        is_asking = bool(self.report and self.report.get("is_waiting"))
        return is_asking and self.status == Status.SUCCEEDED
