"""Audit labels: which pairs disagree with their command, with a parser, or with their own words."""

from __future__ import annotations

from annotations.language.auditing.checks import (
    Answer,
    check_answers,
    check_commands,
    check_words,
)
from annotations.language.auditing.findings import LabelledPair, Reason, Suspect, rank
from annotations.language.auditing.folds import LEAST_FOLDS, MOST_FOLDS, assign_folds, source_key

__all__ = [
    "LEAST_FOLDS",
    "MOST_FOLDS",
    "Answer",
    "LabelledPair",
    "Reason",
    "Suspect",
    "assign_folds",
    "check_answers",
    "check_commands",
    "check_words",
    "rank",
    "source_key",
]
