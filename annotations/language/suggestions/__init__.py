"""Suggest a template for a command without a form: a pattern that is general enough, and likely forms."""

from __future__ import annotations

from annotations.language.suggestions.analogy import solve as solve_analogy
from annotations.language.suggestions.patterns import PatternMaker, nearest_patterns
from annotations.language.suggestions.suggester import (
    MOST_SUGGESTIONS,
    SURE_SHARE,
    FormSuggester,
    Suggestion,
)
from annotations.language.suggestions.transfer import lift_forms, transfer_form

__all__ = [
    "MOST_SUGGESTIONS",
    "SURE_SHARE",
    "FormSuggester",
    "PatternMaker",
    "Suggestion",
    "lift_forms",
    "nearest_patterns",
    "solve_analogy",
    "transfer_form",
]
