"""A place in one line of text, moved forward by the readers of wildcards and sequences."""

from __future__ import annotations

import re

from annotations.language.errors import LanguageError, Position
from annotations.language.limits import require_writable
from annotations.language.symbols.brackets import match_brackets

_SPACES = re.compile(r"\s*")


class Cursor:
    """Reads one line from left to right and knows the position of everything in it.

    ``index`` is the next character; ``pairs`` maps each bracket to its partner.
    """

    def __init__(self, text: str, origin: Position) -> None:
        self.text = text
        self.origin = origin
        self.index = 0
        require_writable(text, origin)
        self.pairs = match_brackets(text, origin)

    @property
    def next(self) -> str:
        """The next character, or an empty string at the end."""
        return self.text[self.index : self.index + 1]

    def position(self, index: int | None = None) -> Position:
        """Return the position of the character at ``index`` (default: the next one)."""
        return self.origin.shifted(self.index if index is None else index)

    def skip_spaces(self) -> None:
        self.match(_SPACES)

    def match(self, pattern: re.Pattern[str]) -> str | None:
        """Move past what ``pattern`` matches here and return it; None if it does not match."""
        match = pattern.match(self.text, self.index)
        if match is None:
            return None
        self.index = match.end()
        return match.group()

    def accept(self, text: str) -> bool:
        """Move past ``text`` if it is next."""
        if not self.text.startswith(text, self.index):
            return False
        self.index += len(text)
        return True

    def fail(self, message: str, hint: str = "", at: int | None = None) -> LanguageError:
        """Return the error to raise about the character at ``at`` (default: the next one)."""
        return LanguageError(message, self.position(at), hint)
