"""Edit an utterance in every way whose effect on its form is known.

Behavioural tests after Ribeiro et al., Beyond accuracy: behavioral testing of NLP models with CheckList, ACL 2020
(invariance and directional expectation), and contrast sets after Gardner et al., Findings of EMNLP 2020.
"""

from __future__ import annotations

from itertools import chain
from random import Random

from annotations.language.forms import Form, canonicalize, equivalent
from parser_service.analysis.edit import EditKind, UtteranceEdit
from parser_service.analysis.facts import WorldFacts
from parser_service.analysis.meaning import exchange_class, exchange_entity, exchange_recipient
from parser_service.analysis.mentions import read_utterance
from parser_service.analysis.wording import (
    change_article,
    change_politeness,
    exchange_synonym,
    misspell,
)


def generate_edits(
    utterance: str, form: Form, facts: WorldFacts, seed: int = 0, most: int = 1
) -> tuple[UtteranceEdit, ...]:
    """Return edits of an utterance, each with the form that it must have.

    Args:
        utterance: anonymized or with the names of entities.
        form: its form, with class tokens or with entities.
        facts: what is known of the world; kinds of edits that need more of it are left out.
        seed: of what is drawn; equal seeds give equal edits, whatever the order of utterances.
        most: edits of one kind.

    Returns:
        Edits by kind, in the order of ``EditKind``. None that makes a known command with another form, or
        that changes a form where it must not, or keeps it where it must change.
    """
    random = Random(f"{seed} {utterance}")
    read = read_utterance(utterance, facts.anonymizer)
    by_kind: dict[EditKind, list[UtteranceEdit]] = {kind: [] for kind in EditKind}
    canonical = canonicalize(form)
    edits = chain(
        exchange_entity(read, canonical, facts, random),
        change_politeness(read, canonical),
        change_article(read, canonical, facts),
        misspell(read, canonical, facts, random),
        exchange_synonym(read, canonical, facts),
        exchange_recipient(read, canonical, facts, random),
        exchange_class(read, canonical, facts, random),
    )
    for edit in edits:
        if edit.text == utterance or facts.contradicts(edit.text, edit.form):
            continue
        if edit.kind.keeps_meaning or not equivalent(edit.form, form):
            by_kind[edit.kind].append(edit)
    chosen = (
        of_kind if len(of_kind) <= most else random.sample(of_kind, most)
        for of_kind in by_kind.values()
    )
    return tuple(edit for of_kind in chosen for edit in of_kind)
