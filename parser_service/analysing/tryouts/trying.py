"""Verb: try a text on runs. The parse server answers, or a worker while there is none; pages show what was
answered so far."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django.db import transaction
from django.utils import timezone

from annotations.jobs import request_job
from annotations.models import Job, JobKind, User, World
from annotations.models.background import JobQuerySet
from parser_service.models import TrainingRun, Tryout
from parser_service.runs.carrying_out.evaluating import BEAM_WIDTH
from parser_service.serving.client import ParserAway, ParserRefused, client

MOST_TEXT = 500  # characters


def ask(world: World, person: User, text: str, runs: Sequence[TrainingRun]) -> Tryout:
    """Ask ``runs`` about a text, in place of the text that the person tried before.

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
    _ask_server(row)
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


def _ask_server(tryout: Tryout) -> None:
    """Store what the parse server answers for the runs that have not; nothing while it is away."""
    answers: dict[str, dict[str, Any]] = {}
    for run in tryout.open_runs:
        try:
            parsed = client().parse(tryout.world.name, tryout.text, BEAM_WIDTH, run)
        except ParserRefused as error:
            answers[str(run)] = {"problem": str(error)}
        except ParserAway:
            break
        else:
            forms = [
                {"form": each["form"], "score": each["score"], "is_cut": parsed["is_cut"]}
                for each in parsed["candidates"]
            ]
            answers[str(run)] = {"answers": forms}
    if not answers:
        return
    with transaction.atomic():
        row = Tryout.objects.select_for_update().get(pk=tryout.pk)
        if row.number == tryout.number:
            row.answers |= answers
            row.is_answered = not row.open_runs
            row.save(update_fields=["answers", "is_answered"])
    tryout.refresh_from_db()


def answer_jobs(world: World) -> JobQuerySet:
    """Return the jobs that answer, or will answer, what is tried in a world."""
    return world.jobs.active().filter(kind=JobKind.ANSWER)
