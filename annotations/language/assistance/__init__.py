"""Help people who write templates: completion, repairs, slots on both sides, layout."""

from __future__ import annotations

from annotations.language.assistance.completion import completions
from annotations.language.assistance.left_out import Usage, usage_of
from annotations.language.assistance.repairs import with_repairs
from annotations.language.assistance.sides import (
    correspondences,
    format_form,
    format_pattern,
    read_known_sides,
)
from annotations.language.assistance.trial import Sides

__all__ = [
    "Sides",
    "Usage",
    "completions",
    "correspondences",
    "format_form",
    "format_pattern",
    "read_known_sides",
    "usage_of",
    "with_repairs",
]
