"""Make a labelled utterance of a dialogue that came to an end."""

from __future__ import annotations

from django.db import transaction

from annotations.labelling import collect
from annotations.language.dialogue import Phase
from annotations.language.forms import canonical_text
from annotations.models import Origin, User, Utterance, UtteranceStatus, Verdict
from annotations.queueing import answer
from parser_service.conversing.talking import state_of
from parser_service.models import Dialogue


def keep(row: Dialogue, by: User) -> Utterance:
    """Store the utterance of a dialogue with the form that the person agreed to, as a label of ``by``.

    An utterance that the world has already keeps the label that it has. Raises ValueError, a sentence,
    for a dialogue without an agreed form, and what ``labelling.label`` raises.
    """
    state = state_of(row)
    if state.phase is not Phase.DONE:
        raise ValueError("Nobody has agreed to a form in this dialogue, so there is none to keep.")
    with transaction.atomic():
        collected = collect(row.world, [row.utterance], Origin.DIALOGUE, by)
        if collected.problems:
            raise ValueError(str(collected.problems[0]))
        utterance = Utterance.objects.get(world=row.world, text=row.utterance)
        if utterance.status == UtteranceStatus.UNLABELLED:
            answer(utterance, Verdict.FORM, canonical_text(state.parsed), by, utterance.version)
        row.kept_as = utterance
        row.save(update_fields=["kept_as"])
    utterance.refresh_from_db()
    return utterance
