"""Wildcards ``{kind? type id where condition meta: text}``, read and printed (FORMATS §1)."""

from __future__ import annotations

from annotations.language.errors import Position
from annotations.language.printing import print_wildcard
from annotations.language.symbol_reader import SymbolReader
from annotations.language.symbols import Wildcard

__all__ = ["print_wildcard", "read_wildcard"]


def read_wildcard(text: str, position: Position | None = None) -> Wildcard:
    """Reads one wildcard with its braces, and nothing else.

    Args:
        text: like ``{placement 2 meta: Block access to {placement 2}}``.
        position: where its first character stands; the start of an unnamed text by default.

    Raises:
        LanguageError: the text is no single well-formed wildcard.
    """
    reader = SymbolReader(text, position or Position())
    reader.skip_spaces()
    if reader.next != "{":
        raise reader.fail("a wildcard begins with {", "write it like {object 1}")
    wildcard = reader.wildcard()
    reader.skip_spaces()
    if reader.next:
        raise reader.fail("there is more than one wildcard here")
    return wildcard
