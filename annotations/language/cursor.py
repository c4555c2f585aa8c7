"""A place in one line of text, moved forward by the readers of wildcards and sequences."""

from __future__ import annotations

import re

from annotations.language.brackets import match_brackets
from annotations.language.errors import LanguageError, Position

_SPACES = re.compile(r"\s*")


class Cursor:
    """Reads one line from left to right and knows the position of everything in it.

    ``index`` is the next character; ``pairs`` maps each bracket to its partner.
    """

    def __init__(self, text: str, origin: Position) -> None:
        self.text = text
        self.origin = origin
        self.index = 0
        self.pairs = match_brackets(text, origin)

    @property
    def next(self) -> str:
        """The next character, or an empty string at the end."""
        return self.text[self.index : self.index + 1]

    def position(self, index: int | None = None) -> Position:
        """The position of the character at ``index`` (default: the next one)."""
        return self.origin.shifted(self.index if index is None else index)

    def skip_spaces(self) -> None:
        self.match(_SPACES)

    def match(self, pattern: re.Pattern[str]) -> str | None:
        """What ``pattern`` matches right here, and moves behind it; None where it does not match."""
        found = pattern.match(self.text, self.index)
        if found is None:
            return None
        self.index = found.end()
        return found.group()

    def accept(self, text: str) -> bool:
        """Moves behind ``text`` if it stands right here."""
        if not self.text.startswith(text, self.index):
            return False
        self.index += len(text)
        return True

    def fail(self, message: str, hint: str = "", at: int | None = None) -> LanguageError:
        """The error to raise about the character at ``at`` (default: the next one)."""
        return LanguageError(message, self.position(at), hint)
