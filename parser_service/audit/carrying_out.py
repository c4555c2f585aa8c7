"""The audit as a job: a worker makes the answers, and stores the findings in one transaction."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from typing import Any

from annotations.auditing import FoundPair, store_findings
from annotations.background.progress import Progress
from annotations.language.auditing import Reason
from annotations.models import Job
from parser_service.audit.auditing import audit_labels
from parser_service.audit.pairs import subject_of
from parser_service.parsers.registry import entry


def audit(job: Job, progress: Progress) -> dict[str, Any]:
    """Audit the labels of the job's world as its arguments say. Returns the report of the job.

    Raises ValueError, a sentence, where there is no such world, or there are too few pairs.
    """
    if job.world is None:
        raise ValueError(f"There is no world {job.world_name} any more.")
    asked = job.arguments
    result = audit_labels(job.world, asked["parser"], asked["folds"], progress=progress)
    found = [FoundPair(subject_of(each.pair), each) for each in result.suspects]
    reasons = Counter(reason for each in result.suspects for reason in each.reasons)
    with progress.writing():
        stored = store_findings(job.world, found, asked["to_queue"], job.created_by)
        report = {
            "pairs": result.pairs,
            "parser": entry(asked["parser"]).title,
            "reasons": {str(reason): reasons[reason] for reason in Reason},
            **asdict(stored),
        }
        progress.conclude(report)
    return report
