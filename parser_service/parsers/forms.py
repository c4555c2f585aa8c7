"""Texts that parsers write, as forms."""

from __future__ import annotations

from functools import lru_cache

from annotations.language.canonical import canonical_text
from annotations.language.errors import LanguageError
from annotations.language.logic import read_form


@lru_cache(maxsize=10_000)
def canonical(text: str) -> str | None:
    """The canonical text of a written form, None where it is no form."""
    try:
        return canonical_text(read_form(text))
    except LanguageError:
        return None


def canonical_or_same(text: str) -> str:
    """The canonical text of a written form, or the text itself where it is no form."""
    found = canonical(text)
    return text if found is None else found
