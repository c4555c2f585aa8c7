"""Verbs: decide whether a label that an audit doubts is right, and take a decision back."""

from __future__ import annotations

from django.db import transaction
from django.utils import timezone

from annotations.auditing.pairs import change_back, change_pair
from annotations.labelling import canonical_label
from annotations.models import AuditDecision, AuditFinding, FindingStatus, User, WorkKind
from annotations.models.corpus import MOST_CHARACTERS
from annotations.models.queueing import decision_choices
from annotations.queueing import NotForThem, settle, unsettle
from annotations.queueing.giving import kinds_for


class DecidedMeanwhile(ValueError):
    """Somebody has decided about the pair, or changed its label, in the meantime; a sentence says so."""


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
        NotForThem: the person's role does not let them decide.
        LanguageError: the form cannot be read.
        ValueError: a sentence where the decision lacks something.
    """
    if decision not in dict(decision_choices()):
        raise ValueError(f"There is no decision {decision[:20]!r}.")
    if WorkKind.AUDIT not in kinds_for(by, finding.world):
        raise NotForThem(f"{by} has no role in this world that decides about labels.")
    with transaction.atomic():
        stored = _lock(finding.pk)
        _require_open(stored)
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


def take_back(made: AuditDecision, by: User) -> AuditFinding:
    """Undo a decision of ``by``: the pair is what it was, and its item in the queue is theirs again.

    Raises ValueError, a sentence, where it is somebody else's, was taken back already, or the pair has
    changed since.
    """
    with transaction.atomic():
        finding = _lock(made.finding_id)
        stored = AuditDecision.objects.select_for_update().get(pk=made.pk)
        if stored.decided_by_id != by.pk:
            raise ValueError("Only the person who decided takes it back.")
        if stored.taken_back_at is not None:
            raise ValueError("This decision has been taken back already.")
        stored.taken_back_at = timezone.now()
        stored.save(update_fields=["taken_back_at"])
        if stored.decision != FindingStatus.KEPT:
            change_back(finding, stored, by)
        subject = finding.subject
        subject.audit_findings.filter(status=FindingStatus.OPEN).delete()  # of another label
        _set(finding, FindingStatus.OPEN, "")
        if not AuditFinding.objects.open().filter(pk=finding.pk).exists():
            raise ValueError("The label has changed since, so there is nothing to decide again.")
        unsettle(subject, WorkKind.AUDIT, by)
    return finding


def _lock(key: int) -> AuditFinding:
    """Return the finding and, in it, its pair, both held until the transaction is over."""
    finding = AuditFinding.objects.select_for_update().get(pk=key)
    name = "utterance" if finding.utterance_id else "paraphrase"
    rows = type(finding.subject)._default_manager.select_for_update()
    setattr(finding, name, rows.get(pk=finding.subject.pk))
    return finding


def _require_open(finding: AuditFinding) -> None:
    if made := finding.decision:
        who = made.decided_by or "Somebody"
        raise DecidedMeanwhile(f"{who} has {made.decision} this label in the meantime.")
    if not AuditFinding.objects.open().filter(pk=finding.pk).exists():
        raise DecidedMeanwhile("The label has changed since the audit. Run it again.")


def _label_after(finding: AuditFinding, decision: str, form: str) -> str:
    """Return the label that the pair has after the decision; empty where it is excluded."""
    if decision == FindingStatus.EXCLUDED:
        return ""
    if decision == FindingStatus.KEPT:
        return finding.form
    if not form and not finding.offers_form:
        raise ValueError("No form is offered here. Write one, or exclude the pair.")
    corrected = canonical_label(form or finding.suggested_form, may_be_unknown=True)
    if corrected == finding.form:
        raise ValueError("This is the label already. Keep it, or write another form.")
    return corrected


def _set(finding: AuditFinding, status: FindingStatus, form: str) -> None:
    finding.status, finding.decided_form = status, form
    finding.save(update_fields=["status", "decided_form"])
