"""Training at one press: the world of today is frozen where that is to be done, and a run starts on it."""

from __future__ import annotations

from typing import Any

from annotations.background.progress import UNWATCHED, PartOfProgress, Progress
from annotations.background.requesting import start_work
from annotations.background.watching import JobProgress
from annotations.generation.freezing import free_name, freeze_split
from annotations.generation.freezing_job import is_large
from annotations.generation.renewing import Unchanged, freeze_anew, last_of
from annotations.language.texts import LanguageError
from annotations.models import Job, JobKind, Split, User, World
from parser_service.parsers.conditions import written_sources
from parser_service.runs.promoting import learned_part
from parser_service.runs.recommended import advise, train_sources, usual_split
from parser_service.runs.run_requests import retrain
from parser_service.runs.starting import Answer, count_started, require_left, start_runs


def start_today(world: World, by: User) -> Job | Answer:
    """Train on ``world`` as it is today, or return the job that freezes it and starts the run.

    Raises TooMany, LanguageError where there is nothing to learn from, and Refusal as ``run_requests.request`` does.
    """
    require_left(by, 1)
    return start_work(is_large(world), JobKind.TRAIN, world, by, {}, lambda: train_today(world, by))


def train_today(world: World, by: User, progress: Progress = UNWATCHED) -> Answer:
    """Return the run of what answers here on a split of today, or of what is recommended there, and whether it is new.

    What was promoted is trained again where the split is newer than its own; else what is recommended is. Raises as
    ``start_today`` does.
    """
    split = split_of_today(world, by, progress)
    learned = learned_part(world)
    if learned is not None and learned.split_id != split.pk:
        require_left(by, 1)
        answer = retrain(learned, split, by)
        count_started(by, 1)
        return answer
    chosen = advise(world, split).recommendation
    sources = written_sources(train_sources(split))
    asked = {"parser": chosen.parser, "protocol": chosen.protocol, "train_sources": sources}
    (answer,) = start_runs(world, by, split=split, seeds=[0], **asked)
    return answer


def split_of_today(world: World, by: User | None, progress: Progress = UNWATCHED) -> Split:
    """Return the usual split of ``world``, frozen anew where that would change it; a first one where there is none."""
    progress = PartOfProgress(progress, 0, 1)  # the run is still to be started
    name = free_name(world)  # first, so that two who ask at once take one name, and get one split
    usual = usual_split(world)
    if usual is None:
        return freeze_split(world, name, by=by, progress=progress)
    newest = last_of(usual)
    try:
        return freeze_anew(newest, by, progress)
    except Unchanged:
        return newest
    except LanguageError:
        if (meanwhile := last_of(newest)) != newest:  # somebody else has just done it
            return meanwhile
        raise


def train_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    """Do what ``train_today`` does for a job. Returns the split and the run, each by its key."""
    if job.world is None or job.created_by is None:
        raise LanguageError(f"the world “{job.world_name}”, or who asked for this, is gone")
    run, _ = train_today(job.world, job.created_by, progress)
    return {"split": run.split_id, "run": run.pk}
