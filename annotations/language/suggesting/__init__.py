"""Suggest a template for a command without a form: a pattern that is general enough, and likely forms."""

from __future__ import annotations

from annotations.language.suggesting.analogy import solve as solve_analogy
from annotations.language.suggesting.lifting import lift_forms
from annotations.language.suggesting.nearest import nearest_patterns
from annotations.language.suggesting.patterns import PatternMaker
from annotations.language.suggesting.suggester import MOST_SUGGESTIONS, FormSuggester, Suggestion
from annotations.language.suggesting.transfer import transfer_form

__all__ = [
    "MOST_SUGGESTIONS",
    "FormSuggester",
    "PatternMaker",
    "Suggestion",
    "lift_forms",
    "nearest_patterns",
    "solve_analogy",
    "transfer_form",
]
