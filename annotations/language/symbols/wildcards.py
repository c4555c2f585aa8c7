"""Read and print wildcards ``{kind? type id where condition meta: text}`` (FORMATS §1)."""

from __future__ import annotations

from annotations.language.errors import Position
from annotations.language.symbols.reader import SymbolReader
from annotations.language.symbols.symbols import Wildcard


def read_wildcard(text: str, position: Position | None = None) -> Wildcard:
    """Read one wildcard with its braces, and nothing else.

    Args:
        text: like ``{placement 2 meta: Block access to {placement 2}}``.
        position: the position of its first character; the start of an unnamed text by default.

    Raises:
        LanguageError: the text is not exactly one well-formed wildcard.
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
