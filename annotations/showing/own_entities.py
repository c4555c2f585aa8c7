"""Say forms of one utterance with the entities that it names: the one place for candidates, labels and answers."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

from annotations.language.forms import Form
from annotations.language.grounding import (
    Anonymized,
    Anonymizer,
    Span,
    deanonymize,
    entities_of,
    ground_like,
)
from annotations.language.world import Entity, Ontology
from annotations.models import Entity as StoredEntity
from annotations.models import Example, Paraphrase, Utterance, World
from annotations.rows.from_rows import ontology_of
from annotations.showing.form_presentation import form_of, gloss_of


@dataclass(frozen=True)
class OwnEntities:
    """What one utterance of ``world`` names.

    ``label`` and ``grounded`` are one form, with class tokens and with entities, where both are stored: those entities
    are certain. The other slots take what the text names, as an answer to it does.
    """

    world: World
    heard: Anonymized
    label: Form | None = None
    grounded: Form | None = None

    @classmethod
    def of_utterance(cls, row: Utterance) -> OwnEntities:
        """Take the spans that are stored with an utterance. One query."""
        names = {name for _, _, _, name in row.spans}
        rows = StoredEntity.objects.filter(ontology__world=row.world_id, text__in=names)
        known = set(rows.values_list("entity_class", "text"))
        spans = []
        for start, end, entity_class, name in row.spans:
            # "a drink" names a category, and is any object of it: there is no object of that name.
            is_one = (entity_class, name) in known
            value = name if is_one else row.text[start:end]
            entity = Entity(entity_class, value)
            spans.append(Span(start, end, f"<{entity_class}>", entity_class, entity, value))
        return cls(row.world, Anonymized(row.text, row.anonymized_text, tuple(spans)))

    @classmethod
    def of_pair(cls, world: World, row: Example | Paraphrase) -> OwnEntities:
        """Take the entities of the form of a pair, and find their words in its text. No query of its own."""
        label, grounded = form_of(row.logical_form), form_of(row.grounded_form or row.logical_form)
        pairs = entities_of(label, grounded) if label and grounded else ()
        entities = tuple(Entity(entity_class, name) for entity_class, name in dict.fromkeys(pairs))
        heard = Anonymizer(Ontology(entities)).anonymize(row.utterance)
        return cls(world, heard, label, grounded)

    @classmethod
    def in_text(cls, world: World, text: str) -> OwnEntities:
        """Find the entities of ``world`` in a text that somebody tries. Reads all entities."""
        return cls(world, Anonymizer(ontology_of(world)).anonymize(text))

    def english(self, text: str) -> str:
        """Write a form of the utterance, in any notation, as an English sentence; empty for what is no form.

        A slot for which the utterance names nothing is said with its class: "the location".
        """
        form = form_of(text)
        return gloss_of(self.world, self.fill(form), self._classes) if form else ""

    def fill(self, form: Form) -> Form:
        """Return the form with the entities in the place of class tokens."""
        if self.label is not None and self.grounded is not None:
            form = ground_like(form, self.label, self.grounded)
        return deanonymize(form, self.heard, Ontology()).form

    @cached_property
    def _classes(self) -> dict[str, str]:
        """Name → class, of names that are of one class alone: a thing is in a room, but at a location."""
        pairs = [(each.entity_class, each.value) for each in self.heard.spans]
        if self.label is not None and self.grounded is not None:
            pairs += entities_of(self.label, self.grounded)
        classes = defaultdict(set)
        for entity_class, name in pairs:
            classes[name].add(entity_class)
        return {name: min(of) for name, of in classes.items() if len(of) == 1}
