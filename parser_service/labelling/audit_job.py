"""The label audit: audit the labels of a world, at once or as a job, and ask for that job."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from http import HTTPStatus
from typing import Any

from annotations.background.progress import UNWATCHED, Progress
from annotations.background.requesting import request_job_once
from annotations.exchange.prompt_sources import CATEGORY_TOKEN
from annotations.labelling.audit_findings import SuspectPair, store_findings
from annotations.labelling.entity_spans import anonymizer_of
from annotations.language.corpus import (
    LabelledPair,
    Reason,
    Suspect,
    check_answers,
    check_commands,
    check_words,
    rank,
)
from annotations.language.texts import ANY_OBJECT, Refusal
from annotations.models import Job, JobKind, User, World
from annotations.rows.synchronise import BATCH
from parser_service.labelling.out_of_fold import AUDITORS, answer_out_of_fold
from parser_service.parsers.interface import Check, Pair
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
    forms = dict(world.commands.values_list("anonymized_text", "logical_form__text"))
    commands = [Pair(text, form) for text, form in forms.items()]
    pairs = _labelled_pairs(world, forms, progress.check)
    answers = answer_out_of_fold(pairs, parser, folds, seed, commands, progress)
    progress.report(1, "ranking the labels")
    findings = [
        *check_commands(pairs),
        *check_words(pairs),
        *check_answers(pairs, answers, entry(parser).title),
    ]
    return AuditedLabels(len(pairs), rank(findings))


def _labelled_pairs(world: World, forms: Mapping[str, str], check: Check) -> list[LabelledPair]:
    """Return the accepted paraphrases and the labelled utterances of ``world`` with class tokens.

    Keys are ``paraphrase-N`` and ``utterance-N`` with the primary key of the row. The command behind a
    paraphrase is the generated one, or else its prompt.

    Args:
        forms: the form of each generated command by its text.
    """
    pairs = []
    anonymizer = anonymizer_of(world)
    columns = ("pk", "utterance", "logical_form", "prompt", "command__anonymized_text")
    paraphrases = world.paraphrases.accepted().values_list(*columns)
    for key, utterance, label, prompt, command in paraphrases.iterator(chunk_size=BATCH):
        check()
        source = command or anonymizer.anonymize(prompt).command
        # A prompt that says "objects" may come from two commands, and the import cannot tell which: then the form
        # behind it is that of either, the label's if it is one of them.
        either = (source, source.replace(ANY_OBJECT, CATEGORY_TOKEN))
        known = [forms[text] for text in either if text in forms]
        behind = label if label in known else next(iter(known), "")
        text = anonymizer.anonymize(utterance).command
        pairs.append(LabelledPair(f"paraphrase-{key}", text, label, source, behind))
    utterances = world.utterances.labelled()
    rows = utterances.values_list("pk", "anonymized_text", "logical_form")
    for key, text, label in rows.iterator(chunk_size=BATCH):
        pairs.append(LabelledPair(f"utterance-{key}", text, label))
    return pairs


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
    found_pairs = []
    for suspect in result.suspects:
        name, _, key = suspect.pair.key.rpartition("-")
        found_pairs.append(SuspectPair((name, int(key)), suspect))
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
