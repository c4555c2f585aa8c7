"""The canonical layout of a pattern and of a form: the printer's text of the value that they have."""

from __future__ import annotations

from annotations.language.errors import LanguageError, Position
from annotations.language.forms import read_form, to_template
from annotations.language.symbols import SymbolReader, print_sequence


def format_pattern(text: str) -> str:
    """Return the pattern with single spaces; a text that cannot be read as it is."""
    try:
        return print_sequence(SymbolReader(text.strip(), Position()).whole_line())
    except LanguageError:
        return text


def format_form(text: str) -> str:
    """Return the form in template notation on one line; a text that cannot be read as it is."""
    try:
        return to_template(read_form(text))
    except LanguageError:
        return text
