"""Verb: correct the label of a paraphrase, whether or not an audit doubts it."""

from __future__ import annotations

from django.db import transaction

from annotations.auditing.deciding import decide
from annotations.auditing.pairs import values_with_label
from annotations.editing.edits import change
from annotations.labelling import canonical_label
from annotations.models import FindingStatus, Paraphrase, User, WorkKind
from annotations.queueing import NotForThem, settle
from annotations.queueing.giving import kinds_for


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
        raise NotForThem(f"{by} has no role in this world that decides about labels.")
    label = canonical_label(form, may_be_unknown=True)
    if label == row.logical_form:
        return row
    with transaction.atomic():
        finding = row.audit_findings.open().first()
        if finding is not None and row.version == version:
            decide(finding, FindingStatus.CORRECTED, by, label)
        else:
            change(row, values_with_label(row, label), by, version)
        settle(row, WorkKind.REQUESTED, by)
    return Paraphrase.objects.get(pk=row.pk)
