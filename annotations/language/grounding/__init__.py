"""Replace wildcards and class tokens with entities, and back; ask for what is missing."""

from __future__ import annotations

from annotations.language.grounding.anonymizer import QUESTION_WORD, Anonymized, Anonymizer, Span
from annotations.language.grounding.deanonymizer import Deanonymized, Slot, deanonymize
from annotations.language.grounding.evidence import Evidence
from annotations.language.grounding.grounding import ground
from annotations.language.grounding.questions import open_slots_as_json, question_for
from annotations.language.grounding.regrounding import ground_like

__all__ = [
    "QUESTION_WORD",
    "Anonymized",
    "Anonymizer",
    "Deanonymized",
    "Evidence",
    "Slot",
    "Span",
    "deanonymize",
    "ground",
    "ground_like",
    "open_slots_as_json",
    "question_for",
]
