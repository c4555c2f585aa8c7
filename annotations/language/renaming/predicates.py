"""Rename a predicate in a logical form."""

from __future__ import annotations

from annotations.language.errors import LanguageError
from annotations.language.forms import read_spans
from annotations.language.renaming.texts import replace_parts


def rename_predicate(text: str, old: str, new: str) -> str:
    """Return a form, in any notation, with ``new`` where ``old`` is a predicate.

    A canonical form stays canonical. A text that is not a form stays as it is.
    """
    if old not in text:
        return text
    try:
        spans = list(read_spans(text).walk())
    except LanguageError:
        return text
    parts = sorted(
        (span.name_start, span.name_end)
        for span in spans
        if span.kind == "application" and span.name == old
    )
    return replace_parts(text, parts, new)
