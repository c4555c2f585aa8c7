"""Starts a verb for a page: carried out at once where it is quick, otherwise as a job.

Each function returns the job to look at, or the report of what has been done already.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django.conf import settings

from annotations.generation.generating import GenerationReport, generate_pairs
from annotations.generation.up_to_date import Outcome, bring_up_to_date
from annotations.importing import ImportReport, PairsReport, import_generator, import_pairs
from annotations.importing.archives import open_archive
from annotations.importing.uploads import files_of, unpacked_pairs, unpacked_size
from annotations.importing.worlds import require_world_name
from annotations.jobs.requesting import keep_question, request_job
from annotations.jobs.weight import (
    MOST_BYTES,
    is_heavy_deletion,
    is_heavy_generation,
    is_heavy_generator,
    is_heavy_pairs,
    is_heavy_world,
)
from annotations.models import Job, JobKind, User, World
from annotations.world_archive import ImportedWorld, import_world
from annotations.worlds.world_deletion import delete_world, request_deletion


def start_generator_import(
    world: World, uploads: Sequence[Any], by: User, brings_back: bool = False
) -> Job | ImportReport:
    """Import now, or queue a job. An import that would remove something becomes a job that asks.

    Raises:
        LanguageError: the uploads cannot be read.
    """
    kind, choice = JobKind.IMPORT_GENERATOR, {"brings_back": brings_back}
    if unpacked_size(uploads) > MOST_BYTES:
        return request_job(kind, world.name, by, choice, uploads)
    files = files_of(uploads)
    if is_heavy_generator(files):
        return request_job(kind, world.name, by, choice, uploads)
    report = import_generator(world.name, files, by, may_remove=False, brings_back=brings_back)
    if report.is_waiting:
        return keep_question(kind, world.name, by, choice, uploads, report.as_json())
    return report


def start_pairs_import(
    world: World, name: str, archive: Any, by: User, brings_back: bool = False
) -> Job | PairsReport:
    """Raises LanguageError where the archive cannot be read."""
    if is_heavy_pairs([archive]):
        kind = JobKind.IMPORT_PAIRS
        arguments = {"name": name, "brings_back": brings_back}
        return request_job(kind, world.name, by, arguments, uploads=[archive])
    with unpacked_pairs(archive) as folder:
        return import_pairs(world.name, name, folder, by, brings_back=brings_back)


def start_world_import(name: str, archive: Any, by: User) -> Job | ImportedWorld:
    """Raises LanguageError where the name or the archive will not do."""
    require_world_name(name)
    bounds = settings.ARCHIVE_MAX_FILES, settings.ARCHIVE_MAX_BYTES
    with open_archive(archive, archive.name, *bounds) as opened:
        size = sum(member.file_size for member in opened.infolist())
    if is_heavy_world(size) and not World.objects.filter(name=name).exists():
        return request_job(JobKind.IMPORT_WORLD, name, by, uploads=[archive])
    return import_world(name, archive, by)


def start_generation(world: World, by: User) -> Job | GenerationReport:
    """Raises LanguageError where the templates cannot be expanded."""
    if is_heavy_generation(world):
        return request_job(JobKind.GENERATE, world.name, by)
    return generate_pairs(world)


def start_update(world: World, by: User) -> Outcome:
    """Bring commands up to date with a change, in the caller's transaction, or ask a worker to.

    The world was marked as changed before. A job that waits to generate it already is enough.
    """
    outcome = bring_up_to_date(world)
    if not outcome.is_up_to_date:
        waiting = Job.objects.queued().filter(kind=JobKind.GENERATE, world=world)
        if not waiting.exists():
            request_job(JobKind.GENERATE, world.name, by)
    return outcome


def start_deletion(world: World, by: User) -> Job | int:
    """Delete now and return the number of rows, or hide the world and return the job that deletes it."""
    if is_heavy_deletion(world):
        request_deletion(world)
        return request_job(JobKind.DELETE_WORLD, world.name, by)
    return delete_world(world)
