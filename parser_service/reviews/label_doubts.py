"""Verb: say that the label of an example is wrong."""

from __future__ import annotations

from annotations.labelling import audit_findings
from annotations.labelling.enqueuing import ItemSubject
from annotations.labelling.sent_examples import send_examples, subject_of_example
from annotations.language.forms import canonical_text, read_or_none
from annotations.language.texts import Refusal
from annotations.models import Example, Paraphrase, SemanticTemplate, User, Utterance
from annotations.models.corpus import ParaphraseStatus, UtteranceStatus
from annotations.rows.occurrences import command_of_example

LONGEST_DOUBT = 250  # characters that say what is wrong with a label
CHANGED = "The label of this example has changed since the split was frozen. Freeze a new split."


def doubt_label(example: Example, reason: str, by: User, right_form: str = "") -> str:
    """Send what is behind ``example`` to the work queue, with the reviewer's ``reason``.

    An accepted paraphrase or a labelled utterance becomes a label in doubt. Anything else is sent as
    ``send_examples`` does: the template of a generated command, or its text as an utterance to label. The
    split itself never changes.

    Args:
        right_form: what the label should be, in any notation, if the reviewer says so.

    Returns:
        A sentence that says what became of it.

    Raises:
        Refusal: where there is no reason, the form is none, or the label has changed since.
    """
    reason = " ".join(reason.replace("\0", "").split())
    if not reason:
        raise Refusal("Say in a few words what is wrong with the label.", "reason_missing")
    suggested = ""
    if right_form:
        form = read_or_none(right_form)
        if form is None:
            raise Refusal(
                "The form that you suggest is not a logical form.", "suggested_form_unreadable"
            )
        suggested = canonical_text(form)
    subject = subject_of_example(example)
    if subject is not None and _label_of(subject, example) not in (None, example.logical_form):
        raise Refusal(CHANGED, "label_changed")
    if isinstance(subject, Paraphrase | Utterance) and _label_of(subject, example):
        audit_findings.doubt(subject, reason, by, *([suggested] if suggested else []))
        return "In the work queue, as a label in doubt."
    return send_examples(
        example.split.world, [example], f"is the label right? {reason}", by
    ).sentence


def _label_of(subject: ItemSubject, example: Example) -> str | None:
    """Return the label that ``subject`` has or makes now; None where it has none that counts."""
    if isinstance(subject, SemanticTemplate):
        command = command_of_example(example)
        return command.logical_form.text if command else None
    counts = {Paraphrase: ParaphraseStatus.ACCEPTED, Utterance: UtteranceStatus.LABELLED}
    return subject.logical_form if subject.status == counts[type(subject)] else None
