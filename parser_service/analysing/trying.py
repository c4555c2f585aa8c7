"""Verb: try a text on runs. A worker answers; pages show what it has answered so far."""

from __future__ import annotations

from collections.abc import Sequence

from django.db import transaction
from django.utils import timezone

from annotations.jobs import request_job
from annotations.models import Job, JobKind, User, World
from annotations.models.jobs import JobQuerySet
from parser_service.models import TrainingRun, Tryout

MOST_TEXT = 500  # characters


def ask(world: World, person: User, text: str, runs: Sequence[TrainingRun]) -> Tryout:
    """Let a worker ask ``runs`` about a text, in place of the text that the person tried before.

    Runs that have answered the very text are not asked again.
    """
    keys = [run.pk for run in runs]
    with transaction.atomic():
        Tryout.objects.get_or_create(world=world, person=person)
        row = Tryout.objects.select_for_update().get(world=world, person=person)
        if (row.text, row.runs) != (text, keys):
            is_new = row.text != text
            if is_new and row.is_answered and row.answers:
                row.before = row.as_before()
            known = {} if is_new else row.answers
            row.answers = {str(key): known[str(key)] for key in keys if str(key) in known}
            row.text, row.runs, row.number = text, keys, row.number + 1
            row.asked_at, row.is_answered = timezone.now(), not row.open_runs
            row.save()
    request_answers(row)
    return row


def request_answers(tryout: Tryout) -> Job | None:
    """Queue the job that answers what is tried in a world, unless one waits or works, or nothing is open.

    However much somebody types, there is one job: it takes the newest text of everybody.
    """
    if tryout.is_answered:
        return None
    active = answer_jobs(tryout.world).first()
    return active or request_job(JobKind.ANSWER, tryout.world.name, tryout.person)


def answer_jobs(world: World) -> JobQuerySet:
    """Return the jobs that answer, or will answer, what is tried in a world."""
    return world.jobs.active().filter(kind=JobKind.ANSWER)
