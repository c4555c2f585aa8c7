"""Starts the import of a world: at once where it is small, otherwise as a job, which a worker carries out."""

from __future__ import annotations

from typing import Any

from django.conf import settings

from annotations.background.job_files import kept_uploads
from annotations.background.job_weight import MOST_BYTES
from annotations.background.requesting import request_job
from annotations.background.watching import JobProgress
from annotations.exchange.archives import open_archive
from annotations.exchange.hidden_worlds import hidden_name, remove_hidden_worlds
from annotations.exchange.target_world import require_world_name
from annotations.exchange.world_import import ImportedWorld, import_world
from annotations.models import Job, JobKind, User, World


def start_world_import(name: str, archive: Any, by: User) -> Job | ImportedWorld:
    """Raises LanguageError where the name or the archive will not do."""
    require_world_name(name)
    bounds = settings.ARCHIVE_MAX_FILES, settings.ARCHIVE_MAX_BYTES
    with open_archive(archive, archive.name, *bounds) as opened:
        size = sum(member.file_size for member in opened.infolist())
    if is_heavy_world(size) and not World.objects.filter(name=name).exists():
        return request_job(JobKind.IMPORT_WORLD, name, by, uploads=[archive])
    return import_world(name, archive, by)


def is_heavy_world(size: int) -> bool:
    """Return whether importing an archive of ``size`` bytes, unpacked, takes long."""
    return size > MOST_BYTES


def import_world_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    name = hidden_name(job)
    remove_hidden_worlds(name)  # of an attempt that was interrupted
    with kept_uploads(job) as (archive,):
        imported = import_world(job.world_name, archive, job.created_by, progress, name)
    return imported.as_json()
