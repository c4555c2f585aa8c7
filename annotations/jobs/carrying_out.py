"""Carries a job out in a worker: finds its verb, gives it the files, keeps its report."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.utils.module_loading import import_string

from annotations import background
from annotations.generation.generating import generate_pairs
from annotations.importing import import_generator, import_pairs
from annotations.importing.uploads import files_of, unpacked_pairs
from annotations.jobs.files import forget_files, kept_uploads
from annotations.jobs.kinds import registered_verb
from annotations.jobs.sweeping import hidden_name, remove_hidden_worlds, sweep
from annotations.jobs.watching import JobProgress
from annotations.language.errors import LanguageError
from annotations.models import Job, JobKind, World
from annotations.world_archive import import_world
from annotations.worlds.world_deletion import delete_world

Report = dict[str, Any]


def carry_out(job: Job, give_up: Callable[[], None] | None = None) -> None:
    """Bring a claimed job to its end, and clear away what jobs before it have left."""
    background.while_held(job, lambda lease: _do(job, lease), give_up)
    job.refresh_from_db()
    if job.is_ended and not job.is_waiting_for_answer:
        forget_files(job)
    sweep()


def _do(job: Job, lease: background.Lease) -> None:
    progress = JobProgress(job, lease)
    report = _verb_of(JobKind(job.kind))(job, progress)
    if progress.is_concluded:
        return
    errors = sum(problem["severity"] == "error" for problem in report.get("problems", ()))
    if errors:
        sentence = f"Nothing was imported: {errors} error{'s' if errors > 1 else ''}."
        background.fail(job, sentence, report=report)
    else:
        background.finish(job, report=report)


def _import_generator(job: Job, progress: JobProgress) -> Report:
    with kept_uploads(job) as uploads:
        files = files_of(uploads)
    choices = {name: bool(job.arguments.get(name)) for name in ("may_remove", "brings_back")}
    return import_generator(job.world_name, files, job.created_by, progress, **choices).as_json()


def _import_pairs(job: Job, progress: JobProgress) -> Report:
    name, brings_back = job.arguments["name"], bool(job.arguments.get("brings_back"))
    with kept_uploads(job) as (archive,), unpacked_pairs(archive) as folder:
        report = import_pairs(
            job.world_name, name, folder, job.created_by, progress, brings_back=brings_back
        )
        return report.as_json()


def _import_world(job: Job, progress: JobProgress) -> Report:
    name = hidden_name(job)
    remove_hidden_worlds(name)  # of an attempt that was interrupted
    with kept_uploads(job) as (archive,):
        imported = import_world(job.world_name, archive, job.created_by, progress, name)
    return imported.as_json()


def _generate(job: Job, progress: JobProgress) -> Report:
    world = job.world
    if world is None:
        raise LanguageError(f"there is no world “{job.world_name}” any more")
    limits = {"limit": job.arguments["limit"]} if "limit" in job.arguments else {}
    return generate_pairs(world, progress=progress, **limits).as_json()


def _delete_world(job: Job, progress: JobProgress) -> Report:
    world = World.objects.filter(name=job.world_name, deletion_requested_at__isnull=False).first()
    return {"rows": delete_world(world, progress)} if world else {"rows": 0}


def _verb_of(kind: JobKind) -> Callable[[Job, JobProgress], Report]:
    return VERBS.get(kind) or import_string(registered_verb(kind))


VERBS: dict[JobKind, Callable[[Job, JobProgress], Report]] = {
    JobKind.IMPORT_GENERATOR: _import_generator,
    JobKind.IMPORT_PAIRS: _import_pairs,
    JobKind.IMPORT_WORLD: _import_world,
    JobKind.GENERATE: _generate,
    JobKind.DELETE_WORLD: _delete_world,
}
