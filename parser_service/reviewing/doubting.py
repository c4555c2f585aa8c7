"""Verb: say that the label of an example is wrong."""

from __future__ import annotations

from annotations import auditing
from annotations.language.forms import canonical_text
from annotations.models import Example, Paraphrase, SemanticTemplate, User, Utterance
from annotations.models.corpus import ParaphraseStatus, UtteranceStatus
from annotations.queueing import send_examples
from annotations.queueing.enqueuing import Subject
from annotations.queueing.sending import subject_of_example
from annotations.rows.occurrences import command_of_example
from parser_service.analysis.reading import read_or_none

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
        ValueError: a sentence, where there is no reason, the form is none, or the label has changed since.
    """
    said = " ".join(reason.replace("\0", "").split())
    if not said:
        raise ValueError("Say in a few words what is wrong with the label.")
    suggested = _canonical(right_form)
    subject = subject_of_example(example)
    if subject is not None and _label_of(subject, example) not in (None, example.logical_form):
        raise ValueError(CHANGED)
    if isinstance(subject, Paraphrase | Utterance) and _label_of(subject, example):
        auditing.doubt(subject, said, by, *([suggested] if suggested else []))
        return "In the work queue, as a label in doubt."
    return send_examples(example.split.world, [example], f"is the label right? {said}", by).sentence


def _canonical(text: str) -> str:
    if not text:
        return ""
    form = read_or_none(text)
    if form is None:
        raise ValueError("The form that you suggest is not a logical form.")
    return canonical_text(form)


def _label_of(subject: Subject, example: Example) -> str | None:
    """Return the label that ``subject`` has or makes now; None where it has none that counts."""
    if isinstance(subject, SemanticTemplate):
        command = command_of_example(example)
        return command.logical_form.text if command else None
    counts = {Paraphrase: ParaphraseStatus.ACCEPTED, Utterance: UtteranceStatus.LABELLED}
    return subject.logical_form if subject.status == counts[type(subject)] else None
