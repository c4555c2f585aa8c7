"""What the analyses of a run have found, in the rows that keep it: each analysis as soon as it is done."""

from __future__ import annotations

from typing import Any

from django.utils import timezone

from annotations.background.progress import Progress
from parser_service.models import RunAnalysis, TrainingRun

# Raised whenever an analysis gives other values or another shape; older findings are made again.
VERSION = 1


def findings_of(run: TrainingRun, part: str) -> dict[str, Any]:
    """Return name → plain values of what is known of a part, as this version of the code finds it."""
    row = run.analyses.filter(part=part, version=VERSION).first()
    return row.findings if row else {}


def keep_finding(run: TrainingRun, part: str, name: str, value: Any, progress: Progress) -> None:
    """Store what one analysis has found; findings of other versions go. Raises what ``progress`` raises."""
    with progress.writing():
        TrainingRun.objects.select_for_update().get(pk=run.pk)  # one of two jobs waits
        findings = {**findings_of(run, part), name: value}
        RunAnalysis.objects.update_or_create(
            run=run,
            part=part,
            defaults={"version": VERSION, "findings": findings, "made_at": timezone.now()},
        )
