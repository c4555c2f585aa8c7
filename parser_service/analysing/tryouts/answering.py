"""Answer the texts that people try, as a job. It stays for a while, since loading a parser takes seconds."""

from __future__ import annotations

import time
from typing import Any

from django.conf import settings

from annotations.background import kinds
from annotations.background.progress import Progress
from annotations.models import Job, World
from parser_service.models import TrainingRun, Tryout, Worker
from parser_service.parsers.interface import Parser
from parser_service.runs.carrying_out.evaluating import BEAM_WIDTH
from parser_service.serving.loading import load_parser

STAY_SECONDS = 20.0  # after the last text
LONGEST_SECONDS = 600.0
LOOK_EVERY = 0.1
MOST_LOADED = 8  # parsers that one job keeps


def answer(job: Job, progress: Progress) -> dict[str, Any]:
    """Answer the newest text of each person in the job's world, then wait for further ones.

    It ends when nothing was tried for a while, or as soon as other work waits for its worker. Returns the
    report of the job.
    """
    if job.world is None:
        raise ValueError(f"There is no world {job.world_name} any more.")
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
    return any(kind.model.objects.queued().filter(queue__in=queues).exists() for kind in kinds())


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
            if not self._keep(tryout, key, answers):
                return
        self.count += 1

    def _ask(self, run: TrainingRun, text: str) -> dict[str, Any]:
        try:
            parser = self._parser_of(run)
        except ValueError as error:
            return _problem(str(error))
        (candidates,) = parser.predict([text], BEAM_WIDTH, self._progress.check)
        return {
            "answers": [
                {"form": each.form, "score": each.score, "is_cut": each.is_cut}
                for each in candidates
            ]
        }

    def _parser_of(self, run: TrainingRun) -> Parser:
        if run.pk not in self._parsers:
            while len(self._parsers) >= MOST_LOADED:
                del self._parsers[next(iter(self._parsers))]
            self._parsers[run.pk] = load_parser(run)
        return self._parsers[run.pk]

    def _keep(self, tryout: Tryout, run: int, answers: dict[str, Any]) -> bool:
        """Store what a run answers. Returns False where the text is no longer the newest."""
        with self._progress.writing():
            row = Tryout.objects.select_for_update().filter(pk=tryout.pk).first()
            if row is None or row.number != tryout.number:
                return False
            row.answers[str(run)] = answers
            row.is_answered = not row.open_runs
            row.save(update_fields=["answers", "is_answered"])
        return True


def _problem(sentence: str) -> dict[str, Any]:
    return {"problem": sentence}
