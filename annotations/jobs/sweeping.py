"""Clears away what interrupted jobs have left: files that nobody needs, worlds that nobody sees."""

from __future__ import annotations

import re
import shutil
from datetime import timedelta
from pathlib import Path

from django.utils import timezone

from annotations.jobs.files import jobs_folder
from annotations.models import Job, JobKind, World
from annotations.worlds.world_deletion import delete_world

# How long an import that asks waits for its answer, and how long work outside of any job may take.
KEPT_FOR = timedelta(days=1)
_HIDDEN_NAME = re.compile(r"importing-job-(?P<job>\d+)")


def hidden_name(job: Job) -> str:
    """Return what a world is called while ``job`` imports it."""
    return f"importing-job-{job.pk}"


def remove_hidden_worlds(name: str) -> None:
    for world in World.objects.filter(name=name, deletion_requested_at__isnull=False):
        delete_world(world)


def sweep() -> None:
    """Remove folders of jobs that are over, and hidden worlds that no job works on any more."""
    _sweep_folders()
    active = set(Job.objects.active().values_list("pk", flat=True))
    for world in World.objects.filter(deletion_requested_at__isnull=False):
        if _is_forgotten(world, active):
            delete_world(world)


def _sweep_folders() -> None:
    folders = [path for path in jobs_folder().glob("*") if path.is_dir()]
    keys = [int(path.name) for path in folders if path.name.isdigit()]
    jobs = {job.pk: job for job in Job.objects.filter(pk__in=keys)}
    for folder in folders:
        job = jobs.get(int(folder.name)) if folder.name.isdigit() else None
        if _is_needless(folder, job):
            shutil.rmtree(folder, ignore_errors=True)


def _is_needless(folder: Path, job: Job | None) -> bool:
    if job is None:  # files on their way, or of a world that was deleted
        return _is_old(folder) or not folder.name.startswith("incoming-")
    if job.is_waiting_for_answer:
        return _is_old(folder)
    return job.is_ended


def _is_old(folder: Path) -> bool:
    try:
        changed = folder.stat().st_mtime
    except OSError:  # another worker swept it
        return False
    return changed < (timezone.now() - KEPT_FOR).timestamp()


def _is_forgotten(world: World, active: set[int]) -> bool:
    """Return whether the hidden ``world`` is neither being imported nor being deleted."""
    match = _HIDDEN_NAME.fullmatch(world.name)
    if match:
        return int(match["job"]) not in active
    deletions = Job.objects.active().filter(kind=JobKind.DELETE_WORLD, world_name=world.name)
    is_old = world.deletion_requested_at < timezone.now() - KEPT_FOR
    return is_old and not deletions.exists()
