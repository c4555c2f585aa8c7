"""Remove the folders of runs that were deleted, alone or with their world."""

from __future__ import annotations

from datetime import timedelta

from django.conf import settings
from django.db.models import Exists, OuterRef
from django.utils import timezone

from parser_service.models import RunFolder, TrainingRun
from parser_service.runs.checkpoints import remove_folder, run_folder

# A child that trains when its run is deleted may still write a checkpoint before it notices.
FORGET_AFTER = timedelta(seconds=600 / settings.WORK_TEMPO)


def keep_track_of(run: TrainingRun) -> None:
    """Record that ``run`` is about to have a folder."""
    RunFolder.objects.get_or_create(run_number=run.pk)


def remove_orphans() -> list[int]:
    """Remove the folders of deleted runs; return their numbers. Called by the timers of the workers."""
    runs = TrainingRun.objects.filter(pk=OuterRef("run_number"))
    orphans = list(RunFolder.objects.filter(~Exists(runs)))
    now = timezone.now()
    there = [number for each in orphans if run_folder(number := each.run_number).exists()]
    for number in there:
        remove_folder(run_folder(number))
    RunFolder.objects.filter(pk__in=[each.pk for each in orphans], orphaned_at=None).update(
        orphaned_at=now
    )
    RunFolder.objects.filter(orphaned_at__lt=now - FORGET_AFTER).delete()
    return there
