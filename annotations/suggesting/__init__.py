"""Suggests a pattern for a command and forms for a pattern, and finds templates that say the same."""

from annotations.suggesting.duplicates import duplicate_of
from annotations.suggesting.parser_answers import add_answers, command_for
from annotations.suggesting.suggestions import (
    MOST_COMMAND,
    ParserAnswer,
    SuggestedForm,
    moved_form,
    suggest_forms,
    suggest_nearest,
    suggest_pattern,
)

__all__ = [
    "MOST_COMMAND",
    "ParserAnswer",
    "SuggestedForm",
    "add_answers",
    "command_for",
    "duplicate_of",
    "moved_form",
    "suggest_forms",
    "suggest_nearest",
    "suggest_pattern",
]
