"""Verbs: store what an audit found, beside what people have decided before, and doubt a label as a reviewer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from django.db import transaction
from django.utils import timezone

from annotations.labelling.enqueuing import ItemSubject, WantedItem, enqueue
from annotations.labelling.entity_spans import anonymizer_of
from annotations.labelling.giving import close_item
from annotations.language.corpus import Reason, Suspect
from annotations.language.forms import UNKNOWN, canonical_text
from annotations.models import (
    AuditFinding,
    AuditReason,
    FindingStatus,
    Paraphrase,
    SemanticTemplate,
    User,
    Utterance,
    WorkKind,
    World,
)
from annotations.models.queueing import REVIEWER
from annotations.rows.synchronise import batches

BATCH = 500
SUBJECTS = ("paraphrase", "utterance")
# What the work queue says of a label, the strongest reason first.
SAYS = {
    Reason.COMMAND: "the command behind it has another form",
    Reason.WORD: "a word of it contradicts the form",
    Reason.PARSER: "a parser that did not see it answers with another form",
}

# Name of the subject in ``AuditFinding``, and its key.
SubjectKey = tuple[str, int]
FIRST = 1  # the rank of what people doubt: before most of what an audit finds
NO_FORM = canonical_text(UNKNOWN)


@dataclass(frozen=True, slots=True)
class SuspectPair:
    """A suspect of an audit, and the row that it is about: its field in ``AuditFinding`` and its key."""

    subject: SubjectKey
    suspect: Suspect


@dataclass(frozen=True, slots=True)
class StoredAudit:
    """How many findings are open now, how many of them are new, how many pairs people had decided about
    before, and how many findings went into the work queue."""

    open: int
    new: int
    decided: int
    queued: int


def store_findings(
    world: World, suspects: Sequence[SuspectPair], to_queue: int = 0, by: User | None = None
) -> StoredAudit:
    """Replace the findings of the last audit, inside a transaction.

    What people have decided about stays as it is, and comes back only where its label has changed since.
    What reviewers doubt stays open.
    The first ``to_queue`` open findings go into the work queue, asked for by ``by``.
    """
    subjects = _subjects(world, suspects)
    decided = set(_decided_labels(world))
    open_rows = world.audit_findings.filter(status=FindingStatus.OPEN).select_for_update()
    old = {
        ("paraphrase", row.paraphrase_id)
        if row.paraphrase_id
        else ("utterance", row.utterance_id): row
        for row in open_rows
    }
    suspects = [each for each in suspects if each.subject in subjects]
    ranks = {each.subject: rank for rank, each in enumerate(suspects, start=1)}
    left = [each for each in suspects if (each.subject, each.suspect.pair.form) not in decided]
    rows: dict[SubjectKey, AuditFinding] = {}
    for pair in left:
        name, key = subject = pair.subject
        rows[subject] = old.get(subject) or AuditFinding(world=world, **{f"{name}_id": key})
        _fill(rows[subject], pair, ranks[subject], subjects[subject])
    of_people = set(world.audit_findings.by_reviewers().values_list("pk", flat=True))
    gone = [row.pk for about, row in old.items() if about not in rows and row.pk not in of_people]
    for keys in batches(gone, BATCH):
        AuditFinding.objects.filter(pk__in=keys).delete()
    new = [row for row in rows.values() if row.pk is None]
    known = [row for row in rows.values() if row.pk is not None]
    AuditFinding.objects.bulk_create(new, batch_size=BATCH)
    columns = ["text", "anonymized_text", "source_command", "form", "suggested_form"]
    AuditFinding.objects.bulk_update(
        known, [*columns, "rank", "score", "found_at"], batch_size=BATCH
    )
    _save_reasons([(rows[each.subject], each.suspect) for each in left])
    # Nobody has to look at a label that no finding doubts any more.
    items = world.work_items.open().filter(kind=WorkKind.AUDIT)
    for item in items.select_for_update():
        if item.is_outdated:
            close_item(item)
    wanted = [WantedItem(subjects[each.subject], _sentence(each.suspect)) for each in left]
    queued = enqueue(world, WorkKind.AUDIT, wanted[:to_queue], by)
    return StoredAudit(len(rows), len(new), len(suspects) - len(left), queued)


def _subjects(world: World, suspects: Sequence[SuspectPair]) -> Mapping[SubjectKey, ItemSubject]:
    """Return the rows that the pairs are about; those that are gone meanwhile are left out."""
    rows: dict[SubjectKey, ItemSubject] = {}
    for name, of_world in (("paraphrase", world.paraphrases), ("utterance", world.utterances)):
        wanted = [each.subject[1] for each in suspects if each.subject[0] == name]
        for keys in batches(wanted, BATCH):
            rows.update(((name, row.pk), row) for row in of_world.filter(pk__in=keys))
    return rows


def _decided_labels(world: World) -> Iterator[tuple[SubjectKey, str]]:
    """Yield each pair that people have decided about, with the label that they left it."""
    rows = world.audit_findings.decided().exclude(status=FindingStatus.EXCLUDED)
    for *keys, form in rows.values_list(*(f"{name}_id" for name in SUBJECTS), "decided_form"):
        yield next((name, key) for name, key in zip(SUBJECTS, keys, strict=True) if key), form


def _fill(row: AuditFinding, pair: SuspectPair, rank: int, subject: ItemSubject) -> None:
    suspect = pair.suspect
    assert not isinstance(subject, SemanticTemplate)  # a pair is what somebody said
    row.text = subject.text if isinstance(subject, Utterance) else subject.utterance
    row.anonymized_text = suspect.pair.utterance
    row.source_command = suspect.pair.source_command
    row.form, row.suggested_form = suspect.pair.form, suspect.suggested_form
    row.rank, row.score, row.found_at = rank, suspect.score, timezone.now()


def _save_reasons(rows: Sequence[tuple[AuditFinding, Suspect]]) -> None:
    """Replace the reasons of these findings that an audit gave."""
    for some in batches(rows, BATCH):
        before = AuditReason.objects.filter(finding__in=[row for row, _ in some])
        before.exclude(reason=REVIEWER).delete()
        AuditReason.objects.bulk_create(
            AuditReason(
                finding=row,
                reason=finding.reason,
                sentence=finding.sentence,
                suggested_form=finding.suggested_form,
                score=finding.score,
            )
            for row, suspect in some
            for finding in suspect.findings
        )


def _sentence(suspect: Suspect) -> str:
    reasons = [SAYS[reason] for reason in Reason if reason in suspect.reasons]
    sentence = " and ".join(reasons)
    return f"{sentence[0].upper()}{sentence[1:]}."


def doubt(
    subject: Paraphrase | Utterance, reason: str, by: User, suggested: str = NO_FORM
) -> AuditFinding:
    """Put the label of ``subject`` among the labels in doubt and into the work queue.

    A finding that is open already gets the reason too.

    Args:
        reason: a sentence of the reviewer.
        suggested: the right label, canonical text, if the reviewer says one.
    """
    values: dict[str, Any]
    if isinstance(subject, Utterance):
        about: dict[str, Any] = {"utterance": subject}
        values = {"text": subject.text, "anonymized_text": subject.anonymized_text}
    else:
        about, command = {"paraphrase": subject}, subject.command
        anonymized = anonymizer_of(subject.world).anonymize(subject.utterance)
        values = {
            "text": subject.utterance,
            "anonymized_text": anonymized.command,
            "source_command": command.anonymized_text if command else subject.prompt,
        }
    values |= {
        "form": subject.logical_form,
        "suggested_form": suggested,
        "rank": FIRST,
        "score": 1.0,
    }
    sentence = f"{by} doubts the label: {reason}"
    with transaction.atomic():
        type(subject)._default_manager.select_for_update().get(pk=subject.pk)
        open_ones = AuditFinding.objects.filter(status=FindingStatus.OPEN, **about)
        finding = open_ones.open().first()
        if finding is None:
            open_ones.delete()  # of another label
            finding = AuditFinding.objects.create(world=subject.world, **about, **values)
        elif suggested != NO_FORM and not finding.offers_form:
            finding.suggested_form = suggested
            finding.save(update_fields=["suggested_form"])
        AuditReason.objects.create(
            finding=finding,
            reason=REVIEWER,
            sentence=sentence,
            suggested_form=suggested,
            score=1.0,
        )
        enqueue(subject.world, WorkKind.AUDIT, [WantedItem(subject, sentence)], by)
    return finding
