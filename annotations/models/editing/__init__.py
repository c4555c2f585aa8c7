"""What rows that people edit have in common: versions and history, drafts and comments."""

from __future__ import annotations

from annotations.models.editing.comments import (
    MOST_CHARACTERS_OF_COMMENT,
    Comment,
    EarlierText,
    Notice,
)
from annotations.models.editing.drafts import NEW, Draft
from annotations.models.editing.editable import Editable

__all__ = [
    "MOST_CHARACTERS_OF_COMMENT",
    "NEW",
    "Comment",
    "Draft",
    "EarlierText",
    "Editable",
    "Notice",
]
