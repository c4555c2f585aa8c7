"""Verbs: decide whether a label that an audit doubts is right, correct a label, and take a decision back."""

from __future__ import annotations

from http import HTTPStatus

from django.db import transaction
from django.utils import timezone

from annotations.editing.edits import change, say_who
from annotations.labelling.form_check import canonical_label
from annotations.labelling.giving import NotForThem, kinds_for
from annotations.labelling.label_changes import change_back, change_pair, values_with_label
from annotations.labelling.settling import settle, unsettle
from annotations.language.texts import Refusal
from annotations.models import (
    Assignment,
    AuditDecision,
    AuditFinding,
    FindingStatus,
    Paraphrase,
    User,
    Verdict,
    WorkKind,
)
from annotations.models.corpus import MOST_CHARACTERS
from annotations.models.queueing import decision_choices

# What an answer to the item decides; whoever ends it without one has looked and found nothing wrong.
DECISIONS = {
    "": FindingStatus.KEPT,
    Verdict.FORM: FindingStatus.CORRECTED,
    Verdict.EXCLUDE: FindingStatus.EXCLUDED,
}


class DecidedMeanwhile(Refusal):
    """Somebody has decided about the pair, or changed its label, in the meantime; a sentence says so."""

    code = "decided_meanwhile"
    status = HTTPStatus.CONFLICT


def decide(
    finding: AuditFinding, decision: str, by: User, form: str = "", reason: str = ""
) -> AuditDecision:
    """Keep the label of the pair, correct it, or exclude the pair from new splits.

    The item about it in the work queue is done.

    Args:
        form: the right label in any notation or UNKNOWN, for a correction; the offered one where it is empty.
        reason: why, if the person says so.

    Raises:
        DecidedMeanwhile: the finding is not open any more.
        NoLongerYours: others are asked what the utterance means.
        NotForThem: the person's role does not let them decide.
        LanguageError: the form cannot be read.
        Refusal: where the decision lacks something.
    """
    if decision not in dict(decision_choices()):
        raise Refusal(f"There is no decision {decision[:20]!r}.", "no_such_decision")
    if WorkKind.AUDIT not in kinds_for(by, finding.world):
        raise NotForThem(
            f"{by} has no role in this world that decides about labels.",
            status=HTTPStatus.FORBIDDEN,
        )
    with transaction.atomic():
        stored = _lock(finding.pk)
        _require_open(stored, by)
        made = AuditDecision(
            finding=stored,
            decision=decision,
            form=_label_after(stored, decision, form),
            reason=" ".join(reason.split())[:MOST_CHARACTERS],
            decided_by=by,
        )
        if decision != FindingStatus.KEPT:
            change_pair(stored, made, by)
        made.save()
        _set(stored, FindingStatus(decision), made.form)
        settle(stored.subject, WorkKind.AUDIT, by)
    return made


def take_back_decision(made: AuditDecision, by: User) -> AuditFinding:
    """Undo a decision of ``by``: the pair is what it was, and its item in the queue is theirs again.

    Raises Refusal where it is somebody else's, was taken back already, or the pair has
    changed since.
    """
    with transaction.atomic():
        finding = _lock(made.finding_id)
        stored = AuditDecision.objects.select_for_update().get(pk=made.pk)
        if stored.decided_by_id != by.pk:
            said = "Only the person who decided takes it back."
            raise Refusal(said, "not_their_decision", HTTPStatus.CONFLICT)
        if stored.taken_back_at is not None:
            said = "This decision has been taken back already."
            raise Refusal(said, "already_taken_back", HTTPStatus.CONFLICT)
        stored.taken_back_at = timezone.now()
        stored.save(update_fields=["taken_back_at"])
        if stored.decision != FindingStatus.KEPT:
            change_back(finding, stored, by)
        subject = finding.subject
        subject.audit_findings.filter(status=FindingStatus.OPEN).delete()  # of another label
        _set(finding, FindingStatus.OPEN, "")
        if not AuditFinding.objects.open().filter(pk=finding.pk).exists():
            said = "The label has changed since, so there is nothing to decide again."
            raise Refusal(said, "changed_since", HTTPStatus.CONFLICT)
        unsettle(subject, WorkKind.AUDIT, by)
    return finding


def _lock(key: int) -> AuditFinding:
    """Return the finding and, in it, its pair, both held until the transaction is over."""
    finding = AuditFinding.objects.select_for_update().get(pk=key)
    name = "utterance" if finding.utterance_id else "paraphrase"
    rows = type(finding.subject)._base_manager.select_for_update()  # a deleted utterance, too
    setattr(finding, name, rows.get(pk=finding.subject.pk))
    return finding


def _require_open(finding: AuditFinding, reader: User) -> None:
    if made := finding.decision:
        did = f"{made.decision} this label"
        raise DecidedMeanwhile(say_who(made.decided_by, reader, did))
    if finding.utterance and finding.utterance.deleted_at:
        said = "The utterance has been deleted since the audit."
        raise DecidedMeanwhile(said, "deleted_since")
    if not AuditFinding.objects.open().filter(pk=finding.pk).exists():
        said = "The label has changed since the audit. Run it again."
        raise DecidedMeanwhile(said, "changed_since")


def _label_after(finding: AuditFinding, decision: str, form: str) -> str:
    """Return the label that the pair has after the decision; empty where it is excluded."""
    if decision == FindingStatus.EXCLUDED:
        return ""
    if decision == FindingStatus.KEPT:
        return finding.form
    if not form and not finding.offers_form:
        raise Refusal("No form is offered here. Write one, or exclude the pair.", "no_form_offered")
    corrected = canonical_label(form or finding.suggested_form, may_be_unknown=True)
    if corrected == finding.form:
        raise Refusal("This is the label already. Keep it, or write another form.", "same_label")
    return corrected


def _set(finding: AuditFinding, status: FindingStatus, form: str) -> None:
    finding.status, finding.decided_form = status, form
    finding.save(update_fields=["status", "decided_form"])


def correct_label(row: Paraphrase, form: str, by: User, version: int) -> Paraphrase:
    """Give ``row``, which was at ``version`` when ``by`` saw it, the label ``form``, in any notation or UNKNOWN.

    Its history keeps the old one. Where an audit doubts the label, this decides about it; what a reviewer
    has asked about the row is done.

    Returns:
        The row as it is stored; at the same version where this is its label already.

    Raises:
        LanguageError: the form cannot be read.
        Overtaken: somebody has changed the row in the meantime.
        NotForThem: the person has no role that decides about labels.
    """
    if WorkKind.AUDIT not in kinds_for(by, row.world):
        raise NotForThem(
            f"{by} has no role in this world that decides about labels.",
            status=HTTPStatus.FORBIDDEN,
        )
    label = canonical_label(form, may_be_unknown=True)
    if label == row.logical_form:
        return row
    with transaction.atomic():
        finding = row.audit_findings.open().first()
        if finding is not None and row.version == version:
            try:
                decide(finding, FindingStatus.CORRECTED, by, label)
            except DecidedMeanwhile:  # which may have left the label as it was
                change(row, values_with_label(row, label), by, version, again=False)
        else:
            change(row, values_with_label(row, label), by, version, again=False)
        settle(row, WorkKind.REQUESTED, by)
    return Paraphrase.objects.get(pk=row.pk)


def end_item(assignment: Assignment, verdict: str = "", form: str = "", reason: str = "") -> bool:
    """Decide about the finding that the item of ``assignment`` asks about. Return False where there is none.

    Raises what ``decide`` raises.
    """
    finding = assignment.item.open_finding
    if finding is None:
        return False
    if verdict not in DECISIONS:
        raise Refusal("Keep the label, give the right form, or exclude the pair.", "form_not_right")
    assert assignment.person is not None  # who answers now
    decide(finding, DECISIONS[verdict], assignment.person, form, reason)
    return True
