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
    resolve_slots,
)
from annotations.language.grounding.evidence import Evidence
from annotations.language.grounding.grounding import ground
from annotations.language.grounding.heard import Heard
from annotations.language.grounding.questions import (
    choices_of,
    noun_for,
    open_slots_as_json,
    question_for,
    say_with_blank,
)
from annotations.language.grounding.regrounding import ground_like
from annotations.language.grounding.roles import SlotPath

__all__ = [
    "QUESTION_WORD",
    "Anonymized",
    "Anonymizer",
    "Deanonymized",
    "Evidence",
    "FormSlots",
    "Heard",
    "Slot",
    "SlotPath",
    "Span",
    "choices_of",
    "deanonymize",
    "fill_all",
    "filled",
    "ground",
    "ground_like",
    "noun_for",
    "open_slots_as_json",
    "question_for",
    "resolve_slots",
    "say_with_blank",
]
