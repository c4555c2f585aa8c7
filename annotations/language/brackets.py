"""Which bracket closes which: one pass over a line before anything recursive looks at it.

Doing this first keeps the readers simple and safe: a line nested too deep is refused here, in one
loop, and a referee's note may hold a lone parenthesis ("a) stop following") without confusing them.
"""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.errors import LanguageError, Position

MAX_DEPTH = 64


def match_brackets(text: str, position: Position) -> dict[int, int]:
    """Pairs each ``(`` and ``{`` of one line with the index of what closes it, and back.

    Args:
        text: one line; a backslash takes the meaning from the character after it.
        position: where the line's first character stands.

    Returns:
        Index → index of the partner, both ways. A parenthesis without a partner is absent; it pairs
        only inside its own braces.

    Raises:
        LanguageError: a brace without a partner, or nesting deeper than ``MAX_DEPTH``.
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
        if len(braces) + sum(map(len, parentheses)) > MAX_DEPTH:
            raise LanguageError(
                f"brackets nest deeper than {MAX_DEPTH}",
                position.shifted(index),
                "name the inner part with a nonterminal of its own",
            )
    if braces:
        raise LanguageError(
            "the wildcard opened here is never closed",
            position.shifted(braces[-1]),
            "close it with } on the same line; a comment sign inside must be written \\; or \\#",
        )
    return pairs


def _bare_characters(text: str) -> Iterator[tuple[int, str]]:
    """Every character with its index, but those that a backslash protects."""
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
