"""Asks for jobs, and stops them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from http import HTTPStatus
from pathlib import Path
from typing import Any, TypeVar

from django.db import transaction
from django.utils import timezone

from annotations import background
from annotations.background.job_files import folder_of, forget_files, keep_uploads
from annotations.language.texts import Refusal, say_count
from annotations.models import Job, JobKind, User, World
from annotations.models.background import JobQuerySet, Queue, Status

Outcome = TypeVar("Outcome")


def request_job(
    kind: str,
    world_name: str,
    by: User | None,
    arguments: Mapping[str, Any] | None = None,
    uploads: Sequence[Any] = (),
    queue: str = Queue.QUICK,
) -> Job:
    """Queue a job for the world called ``world_name``, with its files, and wake a worker of ``queue``."""
    folder = keep_uploads(uploads) if uploads else None
    job = _new_job(kind, world_name, by, arguments, uploads)
    job.queue = queue
    with transaction.atomic():
        job.save()
        _take_folder(job, folder)
        background.wake(job)
    return job


def request_job_once(
    waiting: JobQuerySet,
    kind: str,
    world: World,
    by: User | None,
    arguments: Mapping[str, Any] | None = None,
    queue: str = Queue.QUICK,
) -> tuple[Job, bool]:
    """Return the first job of ``waiting`` and False, or queue one for ``world`` and return it and True.

    Whoever asks at the same moment waits, and finds the job of whoever was first.
    """
    with transaction.atomic():
        World.objects.hold().get(pk=world.pk)
        if (job := waiting.all().first()) is not None:
            return job, False
        return request_job(kind, world.name, by, arguments, queue=queue), True


def start_work(
    is_heavy: bool,
    kind: str,
    world: World,
    by: User | None,
    arguments: Mapping[str, Any],
    do: Callable[[], Outcome],
) -> Job | Outcome:
    """Do the work and return what comes of it. Where it is too heavy for a request, return a job of ``kind`` instead:
    the one that is about to do the same already, or a new one."""
    if not is_heavy:
        return do()
    active = world.jobs.active().filter(kind=kind, arguments=arguments)
    return request_job_once(active, kind, world, by, arguments)[0]


def keep_question(
    kind: str,
    world_name: str,
    by: User | None,
    arguments: Mapping[str, Any],
    uploads: Sequence[Any],
    report: Mapping[str, Any],
) -> Job:
    """Keep the files of an import that would remove something, as a job that has asked and ended."""
    folder = keep_uploads(uploads)
    job = _new_job(kind, world_name, by, arguments, uploads)
    now = timezone.now()
    job.status, job.progress, job.report = Status.SUCCEEDED, 1.0, dict(report)
    job.started_at = job.finished_at = now
    with transaction.atomic():
        job.save()
        _take_folder(job, folder)
    return job


def keep_report(
    kind: str,
    world_name: str,
    by: User | None,
    arguments: Mapping[str, Any],
    report: Mapping[str, Any],
) -> Job:
    """Keep what came of work that was quick enough to be done at once, as a job that has ended: a failed one where
    the report refuses it."""
    job = _new_job(kind, world_name, by, arguments, ())
    job.failure = refusal_in(report)
    job.status = Status.FAILED if job.failure else Status.SUCCEEDED
    job.progress, job.report = 1.0, dict(report)
    job.started_at = job.finished_at = timezone.now()
    job.save()
    return job


def refusal_in(report: Mapping[str, Any]) -> str:
    """Return the sentence by which a report says that nothing was imported; empty where no problem is an error."""
    errors = sum(problem["severity"] == "error" for problem in report.get("problems", ()))
    return f"Nothing was imported: {say_count(errors, 'error')}." if errors else ""


def answer_job(job: Job, by: User, arena: str = "") -> Job:
    """Queue the import that ``job`` asked about, now confirmed: it may do what the report says.

    Raises Refusal where the question was answered already, or asks for another ``arena``.
    """
    with transaction.atomic():
        asked = Job.objects.select_for_update().get(pk=job.pk)
        if not asked.is_waiting_for_answer:
            said = "This import has been answered already."
            raise Refusal(said, "already_answered", HTTPStatus.CONFLICT)
        if (arenas := (asked.report or {}).get("arenas", ())) and arena not in arenas:
            raise Refusal(f"Choose one of the arenas {', '.join(arenas)}.", "no_such_arena")
        _settle_question(asked)
        if not folder_of(asked).is_dir():
            said = "The files are no longer here. Choose them again."
            raise Refusal(said, "files_gone", HTTPStatus.CONFLICT)
        answer = _new_job(asked.kind, asked.world_name, by, asked.arguments, ())
        chosen = {"arena": arena} if arenas else {}
        answer.arguments = {**asked.arguments, **chosen, "is_confirmed": True}
        answer.save()
        _take_folder(answer, folder_of(asked))
        background.wake(answer)
    return answer


def cancel_job(job: Job) -> None:
    """Stop a job, or drop an import that asked. Raises Refusal where it has ended."""
    if job.kind == JobKind.DELETE_WORLD:
        raise Refusal(
            "A deletion cannot be stopped: a part of the world may be gone already.",
            "deletion_goes_on",
            HTTPStatus.CONFLICT,
        )
    with transaction.atomic():
        asked = Job.objects.select_for_update().get(pk=job.pk)
        if asked.is_waiting_for_answer:
            _settle_question(asked)
            transaction.on_commit(lambda: forget_files(asked))
            return
    background.cancel(job)
    job.refresh_from_db()
    if job.is_ended:
        forget_files(job)


def _settle_question(job: Job) -> None:
    report = {**(job.report or {}), "is_waiting": False, "is_dropped": True}
    # What people wrote is kept where they can be forgotten, and nowhere else.
    job.report = {name: value for name, value in report.items() if name != "examples"}
    job.save(update_fields=["report"])


def _new_job(
    kind: str,
    world_name: str,
    by: User | None,
    arguments: Mapping[str, Any] | None,
    uploads: Sequence[Any],
) -> Job:
    names = (
        {"files": [getattr(upload, "sent_path", "") or upload.name for upload in uploads]}
        if uploads
        else {}
    )
    return Job(
        kind=kind,
        world=World.objects.present().filter(name=world_name).first(),
        world_name=world_name,
        created_by=by,
        arguments={**(arguments or {}), **names},
        queue=Queue.QUICK,
    )


def _take_folder(job: Job, folder: Path | None) -> None:
    if folder is not None:
        forget_files(job)
        folder.rename(folder_of(job))
