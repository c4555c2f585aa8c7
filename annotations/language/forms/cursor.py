"""A place in one line of text, moved forward by the readers of wildcards and sequences."""

from __future__ import annotations

import re
from collections.abc import Iterator

from annotations.language.texts import MAX_NESTING, LanguageError, Position, require_writable

_SPACES = re.compile(r"\s*")


def match_brackets(text: str, position: Position) -> dict[int, int]:
    """Return the partner of each ``(``, ``)``, ``{`` and ``}`` of one line, by index.

    One loop matches them before anything recursive reads the line. So a line that nests too deep is
    refused here, and a note for the referee may hold a lone parenthesis ("a) stop following").

    Args:
        text: one line; a backslash escapes the character after it.
        position: the position of the line's first character.

    Returns:
        Index → index of the partner, both ways. A parenthesis without a partner is absent;
        parentheses pair only inside the same braces.

    Raises:
        LanguageError: a brace without a partner, or nesting deeper than ``MAX_NESTING``.
    """
    pairs: dict[int, int] = {}
    braces: list[int] = []
    parentheses: list[list[int]] = [[]]
    for index, character in _bare_characters(text):
        if character == "{":
            braces.append(index)
            parentheses.append([])
        elif character == "(":
            parentheses[-1].append(index)
        elif character == "}":
            if not braces:
                raise LanguageError(
                    "a } closes a wildcard that was never opened",
                    position.shifted(index),
                    "open it with {, or write \\} for the character itself",
                )
            parentheses.pop()
            _pair(pairs, braces.pop(), index)
        elif character == ")" and parentheses[-1]:
            _pair(pairs, parentheses[-1].pop(), index)
        if len(braces) + sum(map(len, parentheses)) > MAX_NESTING:
            raise LanguageError(
                f"brackets nest deeper than {MAX_NESTING}",
                position.shifted(index),
                "move the inner part to a nonterminal of its own",
            )
    if braces:
        raise LanguageError(
            "the wildcard opened here is never closed",
            position.shifted(braces[-1]),
            "close it with } on the same line; a comment sign inside must be written \\; or \\#",
        )
    return pairs


def lone_closing_parentheses(text: str) -> tuple[int, ...]:
    """Return where the closing parentheses are that end ``text`` and that nothing in it opens."""
    try:
        pairs = match_brackets(text, Position())
    except LanguageError:
        return ()  # whoever reads the text finds the same
    lone: list[int] = []
    for index, character in _bare_characters(text):
        if character == ")" and index not in pairs:
            lone.append(index)
        elif not character.isspace():
            lone.clear()
    is_at_end = bool(lone) and not text[lone[0] :].replace(")", "").strip()
    return tuple(lone) if is_at_end else ()


def _bare_characters(text: str) -> Iterator[tuple[int, str]]:
    """Yield every character with its index, except those after a backslash."""
    index = 0
    while index < len(text):
        if text[index] == "\\":
            index += 2
            continue
        yield index, text[index]
        index += 1


def _pair(pairs: dict[int, int], start: int, end: int) -> None:
    pairs[start] = end
    pairs[end] = start


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
