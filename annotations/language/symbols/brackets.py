"""Match brackets in one pass over a line, before anything recursive reads it.

This keeps the readers simple and safe: a line that is nested too deep is refused here, in one loop,
and a referee's note may hold a lone parenthesis ("a) stop following") without confusing them.
"""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.errors import LanguageError, Position
from annotations.language.limits import MAX_NESTING


def match_brackets(text: str, position: Position) -> dict[int, int]:
    """Return the partner of each ``(``, ``)``, ``{`` and ``}`` of one line, by index.

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
                raise _never_opened(position.shifted(index))
            parentheses.pop()
            _pair(pairs, braces.pop(), index)
        elif character == ")" and parentheses[-1]:
            _pair(pairs, parentheses[-1].pop(), index)
        if len(braces) + sum(map(len, parentheses)) > MAX_NESTING:
            raise _too_deep(position.shifted(index))
    if braces:
        raise _never_closed(position.shifted(braces[-1]))
    return pairs


def _never_opened(position: Position) -> LanguageError:
    return LanguageError(
        "a } closes a wildcard that was never opened",
        position,
        "open it with {, or write \\} for the character itself",
    )


def _never_closed(position: Position) -> LanguageError:
    return LanguageError(
        "the wildcard opened here is never closed",
        position,
        "close it with } on the same line; a comment sign inside must be written \\; or \\#",
    )


def _too_deep(position: Position) -> LanguageError:
    return LanguageError(
        f"brackets nest deeper than {MAX_NESTING}",
        position,
        "move the inner part to a nonterminal of its own",
    )


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
