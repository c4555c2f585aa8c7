"""The label audit: audit the labels of a world, at once or as a job, and ask for that job."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from http import HTTPStatus
from typing import Any

from annotations.background.progress import UNWATCHED, Progress
from annotations.jobs import request_job_once
from annotations.label_audit.audit_findings import SuspectPair, store_findings
from annotations.language.errors import Refusal
from annotations.language.label_errors import (
    Reason,
    Suspect,
    check_answers,
    check_commands,
    check_words,
    rank,
)
from annotations.models import Job, JobKind, User, World
from parser_service.label_audit.audited_pairs import command_forms, labelled_pairs, subject_of
from parser_service.label_audit.out_of_fold import AUDITORS, answer_out_of_fold
from parser_service.parsers.interface import Pair
from parser_service.parsers.registry import entry


@dataclass(frozen=True, slots=True)
class AuditedLabels:
    """How many pairs were looked at, and those to look at again, the most suspect first."""

    pairs: int
    suspects: tuple[Suspect, ...]


def audit_labels(
    world: World,
    parser: str = AUDITORS[0],
    folds: int = 5,
    seed: int = 0,
    progress: Progress = UNWATCHED,
) -> AuditedLabels:
    """Check the labels of ``world`` against their commands, ``parser`` and their words. Stores nothing.

    Raises Refusal where the parser cannot do this, or there are too few pairs, and what
    ``progress`` raises between utterances to stop it.
    """
    progress.report(0, "reading the pairs")
    forms = command_forms(world)
    commands = [Pair(text, form) for text, form in forms.items()]
    pairs = labelled_pairs(world, forms, progress.check)
    answers = answer_out_of_fold(pairs, parser, folds, seed, commands, progress)
    progress.report(1, "ranking the labels")
    findings = [
        *check_commands(pairs),
        *check_words(pairs),
        *check_answers(pairs, answers, entry(parser).title),
    ]
    return AuditedLabels(len(pairs), rank(findings))


def request_audit(world: World, by: User, choice: Mapping[str, Any]) -> Job:
    """Return the audit of ``world`` that waits or runs, or ask for one with ``choice``.

    Args:
        choice: ``parser``, ``folds`` and ``to_queue``, as the form of the page has them.
    """
    active = world.jobs.active().filter(kind=JobKind.AUDIT)
    return request_job_once(active, JobKind.AUDIT, world, by, choice)[0]


def audit_of(job: Job, progress: Progress) -> dict[str, Any]:
    """Audit the labels of the job's world as its arguments say. Returns the report of the job.

    Raises Refusal where there is no such world, or there are too few pairs.
    """
    if job.world is None:
        raise Refusal(
            f"There is no world {job.world_name} any more.", "world_gone", HTTPStatus.CONFLICT
        )
    asked = job.arguments
    result = audit_labels(job.world, asked["parser"], asked["folds"], progress=progress)
    found_pairs = [SuspectPair(subject_of(each.pair), each) for each in result.suspects]
    reasons = Counter(reason for each in result.suspects for reason in each.reasons)
    with progress.writing():
        stored = store_findings(job.world, found_pairs, asked["to_queue"], job.created_by)
        report = {
            "pairs": result.pairs,
            "parser": entry(asked["parser"]).title,
            "reasons": {str(reason): reasons[reason] for reason in Reason},
            **asdict(stored),
        }
        progress.conclude(report)
    return report
