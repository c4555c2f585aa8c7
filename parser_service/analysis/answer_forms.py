"""Read what a parser wrote, which may be no form."""

from __future__ import annotations

from annotations.language.forms import equivalent, read_or_none

NO_FORM = "not a form"  # stands for what cannot be read where forms are counted


def is_same_answer(first: str, second: str) -> bool:
    """Return whether two answers are equivalent forms, or the very same text."""
    if first == second:
        return True
    left, right = read_or_none(first), read_or_none(second)
    return left is not None and right is not None and equivalent(left, right)
