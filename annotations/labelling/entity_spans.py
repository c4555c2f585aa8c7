"""Which words of an utterance name an entity: found by the anonymizer, mended by people."""

from __future__ import annotations

from copy import copy
from typing import Any

from django.db import transaction

from annotations.editing.edits import change, change_many
from annotations.labelling.label_answers import hold_utterance
from annotations.language.grounding import Anonymizer
from annotations.language.texts import Refusal
from annotations.models import Entity, User, Utterance, World
from annotations.rows.from_rows import ontology_of
from annotations.rows.history import keep_change

MOST_REREAD = 2_000  # utterances that are read again after an alias was added


def anonymizer_of(world: World) -> Anonymizer:
    return Anonymizer(ontology_of(world))


def anonymized_by(anonymizer: Anonymizer, text: str) -> dict[str, Any]:
    """Return the columns of an utterance that follow from its text."""
    anonymized = anonymizer.anonymize(text)
    spans = [
        [span.start, span.end, span.entity_class, span.entity.text] for span in anonymized.spans
    ]
    return {"anonymized_text": anonymized.command, "spans": spans}


def mend_span(
    utterance: Utterance, start: int, end: int, entity: Entity, by: User, version: int
) -> Utterance:
    """Say that ``text[start:end]`` names ``entity``: the words become an alias of it.

    The utterance, and the unlabelled ones that have these words too, are read again. Returns the
    utterance as it is stored.

    Raises:
        AnsweredMeanwhile: the utterance is not at ``version`` any more.
        Refusal: where the words are no name.
    """
    words = " ".join(utterance.text[start:end].split())
    if not 0 <= start < end <= len(utterance.text) or not words:
        raise Refusal("Select the words that name the entity.", "no_words_selected")
    with transaction.atomic():
        # The world first, as whoever renames something holds it: nobody waits for the other then.
        World.objects.hold().get(pk=utterance.world_id)
        stored = hold_utterance(utterance, version, by)
        row = Entity.objects.select_for_update().get(pk=entity.pk)
        names = {name.casefold() for name in (row.text, *row.aliases)}
        if words.casefold() not in names:
            change(row, {"aliases": [*row.aliases, words]}, by, row.version)
        anonymizer = anonymizer_of(stored.world)
        # Other unlabelled utterances with these words are read again.
        rows = stored.world.utterances.unlabelled().filter(text__icontains=words)
        others = rows.exclude(pk=stored.pk).select_for_update()[:MOST_REREAD]
        changes = [(row, anonymized_by(anonymizer, row.text)) for row in others]
        change_many(
            stored.world,
            [
                (row, values)
                for row, values in changes
                if values != {name: getattr(row, name) for name in values}
            ],
            by,
        )
        before = copy(stored)
        for name, value in anonymized_by(anonymizer, stored.text).items():
            setattr(stored, name, value)
        stored.version += 1
        stored.save()
        keep_change(before, stored, by)
    return stored
