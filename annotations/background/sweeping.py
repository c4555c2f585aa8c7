"""Clears away what interrupted jobs have left: files that nobody needs, and what the apps' sweeps find."""

from __future__ import annotations

import shutil
from datetime import timedelta
from pathlib import Path

from django.utils import timezone
from django.utils.module_loading import import_string

from annotations.apps import workbench_apps
from annotations.background.job_files import jobs_folder, results_folder
from annotations.models import Job

# How long an import that asks waits for its answer, and how long work outside of any job may take.
KEPT_FOR = timedelta(days=1)
RESULTS_KEPT_FOR = timedelta(days=7)


def sweep() -> None:
    """Remove folders of jobs that are over, old results, and what else interrupted jobs have left."""
    folders = [path for path in jobs_folder().glob("*") if path.is_dir()]
    jobs = Job.objects.in_bulk([int(path.name) for path in folders if path.name.isdigit()])
    for folder in folders:
        job = jobs.get(int(folder.name)) if folder.name.isdigit() else None
        if job is None:  # files on their way, or of a world that was deleted
            is_needless = _is_old(folder) or not folder.name.startswith("incoming-")
        else:
            is_needless = _is_old(folder) if job.is_waiting_for_answer else job.is_ended
        if is_needless:
            shutil.rmtree(folder, ignore_errors=True)
    for file in results_folder().glob("*"):
        if _is_old(file, RESULTS_KEPT_FOR):
            file.unlink(missing_ok=True)
    for dotted in (dotted for app in workbench_apps() for dotted in app.sweeps):
        import_string(dotted)()


def _is_old(path: Path, kept_for: timedelta = KEPT_FOR) -> bool:
    try:
        changed = path.stat().st_mtime
    except OSError:  # another worker swept it
        return False
    return changed < (timezone.now() - kept_for).timestamp()
