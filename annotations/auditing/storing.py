"""Verb: store what an audit found, beside what people have decided before."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from django.utils import timezone

from annotations.language.auditing import Reason, Suspect
from annotations.models import (
    AuditFinding,
    AuditReason,
    FindingStatus,
    User,
    Utterance,
    WorkKind,
    World,
)
from annotations.models.queueing import REVIEWER
from annotations.queueing import WantedItem, enqueue
from annotations.queueing.enqueuing import Subject
from annotations.queueing.giving import close_item
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


@dataclass(frozen=True, slots=True)
class FoundPair:
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
    world: World, found: Sequence[FoundPair], to_queue: int = 0, by: User | None = None
) -> StoredAudit:
    """Store what an audit found, inside a transaction, in place of what the one before had found.

    What people have decided about stays as it is, and comes back only where its label has changed since.
    What reviewers doubt stays open.
    The first ``to_queue`` open findings go into the work queue, asked for by ``by``.
    """
    subjects = _subjects(world, found)
    decided = set(_decided_labels(world))
    old = _open_findings(world)
    found = [each for each in found if each.subject in subjects]
    ranks = {each.subject: rank for rank, each in enumerate(found, start=1)}
    left = [each for each in found if (each.subject, each.suspect.pair.form) not in decided]
    rows = {each.subject: old.get(each.subject) or _make(world, each) for each in left}
    for each in left:
        _fill(rows[each.subject], each, ranks[each.subject], subjects[each.subject])
    of_people = set(world.audit_findings.by_reviewers().values_list("pk", flat=True))
    gone = [
        row.pk for subject, row in old.items() if subject not in rows and row.pk not in of_people
    ]
    for keys in batches(gone, BATCH):
        AuditFinding.objects.filter(pk__in=keys).delete()
    new = [row for row in rows.values() if row.pk is None]
    _save(list(rows.values()), new)
    _save_reasons([(rows[each.subject], each.suspect) for each in left])
    _close_settled_items(world)
    wanted = [WantedItem(subjects[each.subject], _sentence(each.suspect)) for each in left]
    queued = enqueue(world, WorkKind.AUDIT, wanted[:to_queue], by)
    return StoredAudit(len(rows), len(new), len(found) - len(left), queued)


def _subjects(world: World, found: Sequence[FoundPair]) -> Mapping[SubjectKey, Subject]:
    """Return the rows that the pairs are about; those that are gone meanwhile are left out."""
    rows: dict[SubjectKey, Subject] = {}
    for name, of_world in (("paraphrase", world.paraphrases), ("utterance", world.utterances)):
        wanted = [each.subject[1] for each in found if each.subject[0] == name]
        for keys in batches(wanted, BATCH):
            rows.update(((name, row.pk), row) for row in of_world.filter(pk__in=keys))
    return rows


def _decided_labels(world: World) -> Iterator[tuple[SubjectKey, str]]:
    """Yield each pair that people have decided about, with the label that they left it."""
    rows = world.audit_findings.decided().exclude(status=FindingStatus.EXCLUDED)
    for *keys, form in rows.values_list(*(f"{name}_id" for name in SUBJECTS), "decided_form"):
        yield next((name, key) for name, key in zip(SUBJECTS, keys, strict=True) if key), form


def _open_findings(world: World) -> dict[SubjectKey, AuditFinding]:
    rows = world.audit_findings.filter(status=FindingStatus.OPEN).select_for_update()
    return {
        ("paraphrase", row.paraphrase_id)
        if row.paraphrase_id
        else ("utterance", row.utterance_id): row
        for row in rows
    }


def _make(world: World, found: FoundPair) -> AuditFinding:
    name, key = found.subject
    return AuditFinding(world=world, **{f"{name}_id": key})


def _fill(row: AuditFinding, found: FoundPair, rank: int, subject: Subject) -> None:
    suspect = found.suspect
    row.text = subject.text if isinstance(subject, Utterance) else subject.utterance
    row.anonymized_text = suspect.pair.utterance
    row.source_command = suspect.pair.source_command
    row.form, row.suggested_form = suspect.pair.form, suspect.suggested_form
    row.rank, row.score, row.found_at = rank, suspect.score, timezone.now()


def _save(rows: Sequence[AuditFinding], new: Sequence[AuditFinding]) -> None:
    known = [row for row in rows if row.pk is not None]
    AuditFinding.objects.bulk_create(new, batch_size=BATCH)
    columns = ["text", "anonymized_text", "source_command", "form", "suggested_form"]
    AuditFinding.objects.bulk_update(
        known, [*columns, "rank", "score", "found_at"], batch_size=BATCH
    )


def _save_reasons(rows: Sequence[tuple[AuditFinding, Suspect]]) -> None:
    """Replace the reasons of these findings that an audit gave."""
    for some in batches(rows, BATCH):
        before = AuditReason.objects.filter(finding__in=[row for row, _ in some])
        before.exclude(reason=REVIEWER).delete()
        AuditReason.objects.bulk_create(
            AuditReason(
                finding=row,
                reason=each.reason,
                sentence=each.sentence,
                suggested_form=each.suggested_form,
                score=each.score,
            )
            for row, suspect in some
            for each in suspect.findings
        )


def _close_settled_items(world: World) -> None:
    """Close the items of the work queue about labels that no finding doubts any more."""
    items = world.work_items.open().filter(kind=WorkKind.AUDIT)
    for item in items.select_for_update():
        if item.is_outdated:
            close_item(item)


def _sentence(suspect: Suspect) -> str:
    reasons = [SAYS[reason] for reason in Reason if reason in suspect.reasons]
    sentence = " and ".join(reasons)
    return f"{sentence[0].upper()}{sentence[1:]}."
