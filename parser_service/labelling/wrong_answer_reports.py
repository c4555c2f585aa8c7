"""Verb: say that a parser's answer to an utterance is wrong."""

from __future__ import annotations

from django.db import transaction

from annotations.labelling import audit_findings
from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import WantedItem, enqueue
from annotations.labelling.form_check import canonical_label
from annotations.language.forms import UNKNOWN, canonical_text
from annotations.language.texts import Refusal, normalise_line
from annotations.models import Origin, Proposal, User, WorkKind, World
from annotations.models.corpus import UtteranceStatus
from parser_service.labelling.label_candidates import PERSON
from parser_service.models import TrainingRun
from parser_service.parsers.registry import title_of, untrained

FIRST = 0  # before what parsers propose
NO_RUN = 0
NO_FORM = canonical_text(UNKNOWN)


def report_wrong(
    world: World, utterance: str, answered_by: str, by: User, right_form: str = "", reason: str = ""
) -> str:
    """Put ``utterance`` into the work queue, with the right form where one is given.

    A labelled utterance becomes a label in doubt; any other is stored where it is new, and whoever
    labels it is offered the form first.

    Args:
        answered_by: the parser that answered, as people read it in the queue.
        right_form: a form in any notation with class tokens, or UNKNOWN; may be empty.

    Returns a sentence that says what became of it. Raises LanguageError for a form that is none, and
    Refusal for a text that cannot be an utterance.
    """
    form = canonical_label(right_form, may_be_unknown=True) if right_form.strip() else ""
    reason = " ".join(reason.replace("\0", "").split())
    is_unknown = form == NO_FORM
    right = " (it should be UNKNOWN)" if is_unknown else ""
    why = f"the answer of {answered_by} is wrong{right}{f': {reason}' if reason else '.'}"
    with transaction.atomic():
        collected = collect(world, [utterance], Origin.REVIEW, by)
        row = world.utterances.filter(text=normalise_line(utterance)).first()
        if row is None:
            problems = " ".join(str(problem) for problem in collected.problems)
            raise Refusal(problems or "There is no utterance to send.", "text_refused")
        if row.status == UtteranceStatus.LABELLED:
            audit_findings.doubt(row, why, by, *([form] if form else []))
            return "In the work queue, as a label in doubt."
        if form and not is_unknown:
            Proposal.objects.filter(utterance=row, source=PERSON).delete()
            Proposal.objects.create(
                utterance=row, source=PERSON, run=NO_RUN, rank=FIRST, form=form, score=1.0
            )
        is_new = enqueue(world, WorkKind.REQUESTED, [WantedItem(row, f"{by} says: {why}")], by)
    where = "In the work queue" if is_new else "It was in the work queue already"
    return f"{where}." if not form or is_unknown else f"{where}, with your form offered first."


def say_parser(run: TrainingRun | None, parser: str = "") -> str:
    """Return what people read in the queue of what answered: a run, or ``parser`` where it needs none."""
    if run is None:
        return title_of(parser) if parser in untrained() else "a parser"
    return f"{title_of(run.parser)} (run {run.pk})"
