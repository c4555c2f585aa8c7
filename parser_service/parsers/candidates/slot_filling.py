"""Entities in place of the class tokens of generated commands, so that they read as people speak."""

from __future__ import annotations

from random import Random
from re import Match

from annotations.language.english import ANY_OBJECT
from annotations.language.forms import CLASS_TOKEN
from annotations.language.grounding import QUESTION_WORD
from annotations.language.ontology import Ontology

OBFUSCATED = 0.15  # share of object slots said by their category, as ``{object?}`` says them


class SlotFiller:
    """Draws an entity of the right class for each class token of a text."""

    def __init__(self, ontology: Ontology):
        self._ontology = ontology
        self._singulars = tuple(ontology.singulars.values())

    def fill(self, text: str, random: Random) -> str:
        """Return ``text`` with entities: ``bring me the <object>`` with an object. A class without entities
        keeps its token."""
        return CLASS_TOKEN.sub(lambda token: self._draw(token, random), text)

    def _draw(self, token: Match[str], random: Random) -> str:
        entity_class = token[1].rstrip("0123456789")
        if entity_class == "question":
            return QUESTION_WORD
        if entity_class == "object" and self._singulars and random.random() < OBFUSCATED:
            return random.choice(self._singulars)
        entities = self._ontology.of_class(entity_class)
        if not entities:
            return token[0]
        text = random.choice(entities).text
        if entity_class == "category":
            return random.choice((ANY_OBJECT, text, self._ontology.singular(text)))
        return text
