"""Help somebody who writes a template: completion, repairs, slots on both sides, layout."""

from __future__ import annotations

from annotations.language.writing.completion import completions
from annotations.language.writing.correspondence import correspondences
from annotations.language.writing.formatting import format_form, format_pattern
from annotations.language.writing.left_out import Usage, usage_of
from annotations.language.writing.offering import with_repairs
from annotations.language.writing.trial import Sides

__all__ = [
    "Sides",
    "Usage",
    "completions",
    "correspondences",
    "format_form",
    "format_pattern",
    "usage_of",
    "with_repairs",
]
