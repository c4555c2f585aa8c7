"""Change the label of a paraphrase or an utterance as somebody has decided, and undo it."""

from __future__ import annotations

from http import HTTPStatus

from django.db.models import Exists, OuterRef, QuerySet

from annotations.editing.edits import change, restore
from annotations.labelling import label_answers
from annotations.language.forms import UNKNOWN, canonical_text, read_form
from annotations.language.grounding import ground_like
from annotations.language.texts import Refusal
from annotations.models import (
    AuditDecision,
    AuditFinding,
    Example,
    FindingStatus,
    Paraphrase,
    Split,
    User,
    Verdict,
)
from annotations.models.corpus import ParaphraseStatus
from annotations.rows.history import entry_at


def change_pair(finding: AuditFinding, made: AuditDecision, by: User) -> None:
    """Give the pair the label that ``made``, an unsaved decision, says, and note in it what that made."""
    if finding.paraphrase is not None:
        row = finding.paraphrase
        is_excluded = made.decision == FindingStatus.EXCLUDED
        excluded = {"status": ParaphraseStatus.EXCLUDED}
        values = excluded if is_excluded else values_with_label(row, made.form)
        made.version = change(row, values, by, row.version).version
    elif finding.utterance is not None:
        utterance = finding.utterance
        if made.decision == FindingStatus.EXCLUDED:
            verdict = Verdict.EXCLUDE
        else:
            verdict = Verdict.UNKNOWN if made.form == canonical_text(UNKNOWN) else Verdict.FORM
        form = made.form if verdict == Verdict.FORM else ""
        label_answers.require_may_settle(utterance, by)
        made.label = label_answers.label(
            *(utterance, verdict, form, by, utterance.version), reason=made.reason
        )


def change_back(finding: AuditFinding, made: AuditDecision, by: User) -> None:
    """Undo what a decision made of the pair.

    Raises Refusal where the pair has changed since, or what it was is not known here.
    """
    if made.label is not None:
        label_answers.take_back_label(made.label, by)
        return
    row = finding.paraphrase
    if row is None or row.version != made.version:
        said = "This pair has changed since. Restore it from its history."
        raise Refusal(said, "changed_since", HTTPStatus.CONFLICT)
    entry = entry_at(row, row.version - 1)
    if entry is None:
        said = "The history of this paraphrase does not say what it was before."
        raise Refusal(said, "history_is_silent", HTTPStatus.CONFLICT)
    restore(entry, by)


def values_with_label(row: Paraphrase, label: str) -> dict[str, str]:
    """Return the columns of a paraphrase that get another label, canonical text: its grounded form has the
    entities of the old one where they are certain."""
    if not row.grounded_form:
        return {"logical_form": label}
    forms = map(read_form, (label, row.logical_form, row.grounded_form))
    return {"logical_form": label, "grounded_form": canonical_text(ground_like(*forms))}


def examples_before(split: Split) -> QuerySet[Example]:
    """Return the examples of ``split`` whose pair an audit has corrected or excluded since it was frozen."""
    wrong = AuditFinding.objects.confirmed().filter(
        world=split.world_id, text=OuterRef("utterance"), form=OuterRef("logical_form")
    )
    return split.examples.filter(Exists(wrong))
