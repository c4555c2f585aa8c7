"""Verb: doubt a label, as a reviewer who has read an error."""

from __future__ import annotations

from django.db import transaction

from annotations.labelling.spans import anonymizer_of
from annotations.language.forms import UNKNOWN, canonical_text
from annotations.models import (
    AuditFinding,
    AuditReason,
    FindingStatus,
    Paraphrase,
    User,
    Utterance,
    WorkKind,
)
from annotations.models.queueing import REVIEWER
from annotations.queueing import WantedItem, enqueue

FIRST = 1  # the rank of what people doubt: before most of what an audit finds
NO_FORM = canonical_text(UNKNOWN)


def doubt(
    subject: Paraphrase | Utterance, reason: str, by: User, suggested: str = NO_FORM
) -> AuditFinding:
    """Put the label of ``subject`` among the labels in doubt and into the work queue.

    A finding that is open already gets the reason too.

    Args:
        reason: a sentence of the reviewer.
        suggested: the right label, canonical text, if the reviewer says one.
    """
    about = {"utterance" if isinstance(subject, Utterance) else "paraphrase": subject}
    values = {
        **_texts_of(subject),
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


def _texts_of(subject: Paraphrase | Utterance) -> dict[str, str]:
    """Return the columns of a finding that say what was said, and the command behind it."""
    if isinstance(subject, Utterance):
        return {"text": subject.text, "anonymized_text": subject.anonymized_text}
    command, text = subject.command, subject.utterance
    return {
        "text": text,
        "anonymized_text": anonymizer_of(subject.world).anonymize(text).command,
        "source_command": command.anonymized_text if command else subject.prompt,
    }
