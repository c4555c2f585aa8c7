"""Read what a parser wrote, which may be no form."""

from __future__ import annotations

from annotations.language.errors import LanguageError
from annotations.language.forms import Form, read_form

NO_FORM = "not a form"  # stands for what cannot be read where forms are counted


def read_or_none(text: str) -> Form | None:
    """Return the form that a text writes in any notation; None where it is not a form."""
    try:
        return read_form(text)
    except LanguageError:
        return None
