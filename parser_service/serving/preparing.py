"""What a parser is given for an utterance that somebody typed or said."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

from annotations.language.grounding import Anonymizer, Evidence
from annotations.language.ontology import Ontology
from annotations.language.plans import ActionName, Lookup
from annotations.language.predicates import Predicate
from annotations.models import World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.rows.from_rows import ontology_of, predicates_of
from parser_service.robots.action_names import names_of
from parser_service.robots.evidence import evidence_of

MOST_CANDIDATES = 20


@dataclass(frozen=True, slots=True)
class WorldLanguage:
    """What the texts and forms of a world are read with, as it was at one moment."""

    ontology: Ontology
    predicates: Mapping[str, Predicate]
    anonymizer: Anonymizer
    lookup: Lookup
    evidence: Evidence
    action_names: Mapping[str, ActionName]

    @classmethod
    def of(cls, world: World) -> Self:
        ontology, predicates = ontology_of(world), predicates_of(world)
        return cls(
            ontology,
            predicates,
            Anonymizer(ontology),
            Lookup(ontology, predicates),
            evidence_of(world),
            names_of(world),
        )


def require_utterance(text: object) -> str:
    """Return ``text`` where it is an utterance. Raises ValueError, a sentence, where it is none."""
    if not isinstance(text, str) or not text.strip():
        raise ValueError("There is no utterance: send a text.")
    if "\0" in text:
        raise ValueError("The utterance holds a character that cannot be written (NUL).")
    if len(text) > MOST_CHARACTERS:
        raise ValueError(
            f"The utterance has {len(text):,} characters; at most {MOST_CHARACTERS} are parsed."
        )
    return text


def require_beam(beam: object) -> int:
    """Return ``beam`` where it is a number of candidates. Raises ValueError, a sentence."""
    if not isinstance(beam, int) or isinstance(beam, bool) or not 1 <= beam <= MOST_CANDIDATES:
        raise ValueError(f"beam has to be a whole number from 1 to {MOST_CANDIDATES}.")
    return beam
