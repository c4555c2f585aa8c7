"""Replace wildcards and class tokens with entities, and back; say what stays open."""

from __future__ import annotations

from annotations.language.grounding.anonymizer import QUESTION_WORD, Anonymized, Anonymizer, Span
from annotations.language.grounding.deanonymizer import (
    Deanonymized,
    FormSlots,
    Slot,
    deanonymize,
    fill_all,
    filled,
    ground_like,
    ground_text,
    resolve_slots,
    with_values,
)
from annotations.language.grounding.drawing import may_fill
from annotations.language.grounding.grounding import Grounded, ground
from annotations.language.grounding.questions import (
    choices_of,
    is_asked_plainly,
    named_entities,
    noun_for,
    open_slots_as_json,
    question_for,
)
from annotations.language.grounding.role_evidence import Evidence
from annotations.language.grounding.roles import SlotPath
from annotations.language.grounding.utterance_lattice import HeardLattice, UtteranceReader
from annotations.language.grounding.utterance_mentions import UtteranceMentions

__all__ = [
    "QUESTION_WORD",
    "Anonymized",
    "Anonymizer",
    "Deanonymized",
    "Evidence",
    "FormSlots",
    "Grounded",
    "HeardLattice",
    "Slot",
    "SlotPath",
    "Span",
    "UtteranceMentions",
    "UtteranceReader",
    "choices_of",
    "deanonymize",
    "fill_all",
    "filled",
    "ground",
    "ground_like",
    "ground_text",
    "is_asked_plainly",
    "may_fill",
    "named_entities",
    "noun_for",
    "open_slots_as_json",
    "question_for",
    "resolve_slots",
    "with_values",
]
