"""Edit an utterance in every way whose effect on its form is known.

Behavioural tests after Ribeiro et al., Beyond accuracy: behavioral testing of NLP models with CheckList, ACL 2020
(invariance and directional expectation), and contrast sets after Gardner et al., Findings of EMNLP 2020.
"""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

from annotations.language.forms import Form, canonicalize, equivalent
from parser_service.analysis.edits.edit import Edit, EditKind
from parser_service.analysis.edits.facts import WorldFacts
from parser_service.analysis.edits.meaning import (
    exchange_class,
    exchange_entity,
    exchange_recipient,
)
from parser_service.analysis.edits.mentions import Utterance, read_utterance
from parser_service.analysis.edits.wording import (
    change_article,
    change_politeness,
    exchange_synonym,
    misspell,
)


def generate_edits(
    utterance: str, form: Form, facts: WorldFacts, seed: int = 0, most: int = 1
) -> tuple[Edit, ...]:
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
    by_kind: dict[EditKind, list[Edit]] = {kind: [] for kind in EditKind}
    for edit in _all(read, canonicalize(form), facts, random):
        if _is_sound(edit, utterance, form, facts):
            by_kind[edit.kind].append(edit)
    chosen = (_choose(edits, most, random) for edits in by_kind.values())
    return tuple(edit for edits in chosen for edit in edits)


def _all(utterance: Utterance, form: Form, facts: WorldFacts, random: Random) -> Iterator[Edit]:
    yield from exchange_entity(utterance, form, facts, random)
    yield from change_politeness(utterance, form)
    yield from change_article(utterance, form)
    yield from misspell(utterance, form, facts, random)
    yield from exchange_synonym(utterance, form, facts)
    yield from exchange_recipient(utterance, form, facts, random)
    yield from exchange_class(utterance, form, facts, random)


def _is_sound(edit: Edit, utterance: str, form: Form, facts: WorldFacts) -> bool:
    if edit.text == utterance or facts.contradicts(edit.text, edit.form):
        return False
    return edit.kind.keeps_meaning or not equivalent(edit.form, form)


def _choose(edits: list[Edit], most: int, random: Random) -> list[Edit]:
    return edits if len(edits) <= most else random.sample(edits, most)
