"""Forms in the texts that parsers write."""

from __future__ import annotations

from functools import lru_cache

from annotations.language.errors import LanguageError
from annotations.language.forms import Form, canonical_text, read_form


def read_or_none(text: str) -> Form | None:
    """Return the form that a text writes; None where it is not a form."""
    try:
        return read_form(text)
    except LanguageError:
        return None


@lru_cache(maxsize=10_000)
def canonical(text: str) -> str | None:
    """Return the canonical text of a written form; None where it is not a form."""
    form = read_or_none(text)
    return None if form is None else canonical_text(form)


def canonical_or_same(text: str) -> str:
    """Return the canonical text of a written form, or the text itself where it is not a form."""
    canonical_form = canonical(text)
    return text if canonical_form is None else canonical_form
