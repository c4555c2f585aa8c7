"""Replace wildcards and class tokens with entities, and back; say what stays open."""

from __future__ import annotations

from annotations.language.grounding.anonymizer import QUESTION_WORD, Anonymized, Anonymizer, Span
from annotations.language.grounding.deanonymizer import Deanonymized, Slot, deanonymize, fill_all
from annotations.language.grounding.evidence import Evidence
from annotations.language.grounding.grounding import ground
from annotations.language.grounding.questions import (
    choices_of,
    noun_for,
    open_slots_as_json,
    question_for,
)
from annotations.language.grounding.regrounding import ground_like

__all__ = [
    "QUESTION_WORD",
    "Anonymized",
    "Anonymizer",
    "Deanonymized",
    "Evidence",
    "Slot",
    "Span",
    "choices_of",
    "deanonymize",
    "fill_all",
    "ground",
    "ground_like",
    "noun_for",
    "open_slots_as_json",
    "question_for",
]
