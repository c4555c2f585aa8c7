"""Measure how answers change when an utterance is edited, and which word they hang on."""

from __future__ import annotations

from parser_service.analysis.sensitivity.deciding_words import (
    find_deciding_words,
    remove_words,
    single_word,
)
from parser_service.analysis.sensitivity.edit_outcomes import (
    ALL_KINDS,
    EditAnswers,
    measure_sensitivity,
)

__all__ = [
    "ALL_KINDS",
    "EditAnswers",
    "find_deciding_words",
    "measure_sensitivity",
    "remove_words",
    "single_word",
]
