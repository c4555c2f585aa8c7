"""Measuring what a robot gets: the job, and how somebody asks for it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

from django.conf import settings

from annotations.background.progress import Progress
from annotations.background.requesting import request_job_once
from annotations.language.texts import Refusal
from annotations.models import Job, JobKind, Split, User, World
from annotations.models.background import Queue
from parser_service.analysis.sureness import AnsweredForm
from parser_service.models import AnsweringOrder, TrainingRun
from parser_service.models.answering import answering_of
from parser_service.results.answerer_figures import Answerer, evaluate_answerer
from parser_service.runs.promoting import promoted_run
from parser_service.serving import answerer as serving
from parser_service.serving.default_runs import standings
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf


def request_measurement(world: World, by: User | None, split: Split | None = None) -> Job:
    """Return the measurement of ``world`` that waits or runs, or ask for one on ``split``, by default ``usual_split``,
    where its learned parser was trained. Raises Refusal where there is no split."""
    chosen = split or usual_split(world)
    active = world.jobs.active().filter(kind=JobKind.MEASURE)
    arguments, queue = {"split": chosen.pk}, Queue.QUICK
    if answering_of(world).order != AnsweringOrder.ORACLE:
        promoted = promoted_run(world)
        if promoted is not None:
            queue = Queue(promoted.queue)
    return request_job_once(active, JobKind.MEASURE, world, by, arguments, queue)[0]


def measure(job: Job, progress: Progress) -> dict[str, Any]:
    """Measure what the job's world answers with on the split that its arguments name. Returns the report of the job.

    Raises Refusal where world or split are gone, or nothing can answer, and what ``progress`` raises to stop it.
    """
    world = job.world
    split = world.splits.filter(pk=job.arguments["split"]).first() if world else None
    if world is None or split is None:
        raise Refusal("The world or the split is gone.", "split_gone", HTTPStatus.CONFLICT)
    answerer = answerer_of(world, answering_of(world).order)
    rows = evaluate_answerer(world, split, answerer, progress)
    report = {
        "split": split.name,
        "examples": sum(row.count for row in rows if row.test_source != "mixed"),
        "people": max((row.calibration["examples"] for row in rows), default=0),
    }
    with progress.writing():
        progress.conclude(report)
    return report


@dataclass(frozen=True)
class MeasuredAnswerer:
    """What answers in a world by ``order``, as it is measured."""

    answerer: serving.Answerer
    order: str

    @property
    def run(self) -> TrainingRun | None:
        key = self.answerer.run
        return None if key is None else TrainingRun.objects.get(pk=key)

    @property
    def last_run(self) -> int | None:
        return self.answerer.last.run if self.answerer.last else None

    def answer(self, utterances: Sequence[str]) -> list[AnsweredForm]:
        return self.answerer.measure(utterances)


def answerer_of(world: World, order: str) -> Answerer:
    """Return what answers in ``world`` by an ``AnsweringOrder``. Raises Refusal where nothing can."""
    # Nobody waits for one answer: a language model may take as long as it needs.
    shelf = Shelf(settings.PARSER_MEMORY_MB * 1_000_000, Metrics(), patience=math.inf)
    return MeasuredAnswerer(shelf.load(world.name, order=order), order)


def usual_split(world: World) -> Split:
    """Return the split that pages open on, else the newest. Raises Refusal where there is none."""
    if standing := next(standings(world), None):
        return standing.split
    split = world.splits.order_by("-pk").first()
    if split is None:
        raise Refusal(f"“{world}” has no split. Freeze one, then measure.", "no_split")
    return split
