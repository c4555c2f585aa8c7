"""Try a text on runs: the parse server answers, or a job while there is none. Pages show what was answered so far."""

from __future__ import annotations

import time
from collections.abc import Sequence
from http import HTTPStatus
from typing import Any

from django.conf import settings
from django.db import transaction
from django.utils import timezone

from annotations.background import kinds
from annotations.background.progress import Progress
from annotations.background.requesting import request_job_once
from annotations.language.texts import Refusal
from annotations.models import Job, JobKind, User, World
from annotations.models.background import JobQuerySet
from parser_service.models import TrainingRun, Tryout, Worker
from parser_service.parsers.interface import Parser
from parser_service.runs.evaluating import BEAM_WIDTH
from parser_service.serving.loading import load_parser
from parser_service.serving.parser_client import ParserAway, ParserRefused, client

MOST_TEXT = 500  # characters
STAY_SECONDS = 20.0  # after the last text
LONGEST_SECONDS = 600.0
LOOK_EVERY = 0.1
MOST_LOADED = 8  # parsers that one job keeps


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
    active = answer_jobs(tryout.world)
    if (job := active.first()) is not None:
        return job
    # Read after the look for a job: one that has just ended may have answered what ``tryout`` still asks.
    if not Tryout.objects.waiting().filter(pk=tryout.pk).exists():
        return None
    return request_job_once(active, JobKind.ANSWER, tryout.world, tryout.person)[0]


def _ask_server(tryout: Tryout) -> None:
    """Store what the parse server answers for the runs that have not; nothing while it is away."""
    answers: dict[str, dict[str, Any]] = {}
    for run in tryout.open_runs:
        try:
            parsed = client().parse(tryout.world.name, tryout.text, BEAM_WIDTH, run)
        except ParserRefused as error:
            answers[str(run)] = {"problem": error.message}
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


def answer(job: Job, progress: Progress) -> dict[str, Any]:
    """Answer the newest text of each person in the job's world, then wait for further ones: to load a parser
    takes seconds.

    It ends when nothing was tried for a while, or as soon as other work waits for its worker. Returns the
    report of the job.
    """
    if job.world is None:
        raise Refusal(
            f"There is no world {job.world_name} any more.", "world_gone", HTTPStatus.CONFLICT
        )
    answering = _Answering(job.world, progress)
    began = last = time.monotonic()
    while time.monotonic() - began < LONGEST_SECONDS:
        tryout = Tryout.objects.waiting().filter(world=job.world).first()
        if tryout is not None:
            progress.report(0.5, "answering")
            answering.answer(tryout)
            last = time.monotonic()
            continue
        progress.report(0.5, "waiting for a text")
        is_idle = time.monotonic() - last >= STAY_SECONDS / settings.WORK_TEMPO
        if is_idle or _is_wanted_elsewhere(job):
            break
        time.sleep(LOOK_EVERY)
    return {"answered": answering.count}


def _is_wanted_elsewhere(job: Job) -> bool:
    """Return whether other work waits in a queue that the worker of the job serves."""
    worker = Worker.objects.filter(name=job.worker).first()
    queues = worker.queues if worker else [job.queue]
    return any(kind.objects.queued().filter(queue__in=queues).exists() for kind in kinds())


class _Answering:
    """Asks parsers, which stay loaded; ``count`` is how many texts it has finished."""

    def __init__(self, world: World, progress: Progress) -> None:
        self.count = 0
        self._world = world
        self._progress = progress
        self._parsers: dict[int, Parser] = {}

    def answer(self, tryout: Tryout) -> None:
        """Store an answer of each run; stop where the person has typed on."""
        runs = TrainingRun.objects.filter(world=self._world).in_bulk(tryout.open_runs)
        for key in tryout.open_runs:
            self._progress.check()
            answers = self._ask(runs[key], tryout.text) if key in runs else _problem("It is gone.")
            with self._progress.writing():
                row = Tryout.objects.select_for_update().filter(pk=tryout.pk).first()
                if row is None or row.number != tryout.number:
                    return
                row.answers[str(key)] = answers
                row.is_answered = not row.open_runs
                row.save(update_fields=["answers", "is_answered"])
        self.count += 1

    def _ask(self, run: TrainingRun, text: str) -> dict[str, Any]:
        if run.pk not in self._parsers:
            while len(self._parsers) >= MOST_LOADED:
                del self._parsers[next(iter(self._parsers))]
            try:
                self._parsers[run.pk] = load_parser(run)
            except Refusal as error:
                return _problem(error.message)
        (candidates,) = self._parsers[run.pk].predict([text], BEAM_WIDTH, self._progress.check)
        return {
            "answers": [
                {"form": each.form, "score": each.score, "is_cut": each.is_cut}
                for each in candidates
            ]
        }


def _problem(sentence: str) -> dict[str, Any]:
    return {"problem": sentence}
