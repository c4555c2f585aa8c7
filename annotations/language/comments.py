"""Comments of a grammar file, and the directives that live in them."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass

from annotations.language.errors import LanguageError, Position

# In this order: what a backslash protects, a block, an unclosed block, a comment to the line's end.
_COMMENT = re.compile(
    r"\\.|(?P<block>/\*.*?\*/)|(?P<open>/\*)|(?P<line>(?:[#;%]|//)[^\n]*)", re.DOTALL
)
_LINE_SIGN = re.compile(r"[#;%]|//")
_PATH = r"""(?:"(?P<double>[^"]+)"|'(?P<single>[^']+)'|(?P<bare>\S+))"""
_IMPORT = re.compile(rf"(?:import|load)\s+{_PATH}(?:\s+as\s+\$(?P<alias>\w+))?\s*", re.IGNORECASE)
_HEADING = re.compile(r"grammar\s+(?P<key>name|tier)\s+(?P<value>.+?)\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Comment:
    """The words of one comment, without its sign."""

    text: str
    position: Position


@dataclass(frozen=True, slots=True)
class Import:
    """``; import path`` or ``; import path as $alias``."""

    path: str
    alias: str
    position: Position


def split_comments(text: str, source: str) -> tuple[str, tuple[Comment, ...]]:
    """Takes the comments out of a grammar file.

    Returns:
        The text with spaces where comments stood, so that lines and columns keep their numbers,
        and the comments in order.

    Raises:
        LanguageError: a ``/*`` that is never closed.
    """
    comments: list[Comment] = []
    line_starts = [0, *(found.end() for found in re.finditer("\n", text))]

    def blank(found: re.Match[str]) -> str:
        if found["block"] is None and found["open"] is None and found["line"] is None:
            return found.group()
        place = _place(line_starts, found.start(), source)
        if found["open"]:
            raise LanguageError(
                "the comment opened here is never closed", place, "close it with */"
            )
        words = found["block"][2:-2] if found["block"] else _LINE_SIGN.sub("", found["line"], 1)
        comments.append(Comment(words.strip(), place))
        return re.sub(r"[^\n]", " ", found.group())

    return _COMMENT.sub(blank, text), tuple(comments)


def find_imports(comments: tuple[Comment, ...]) -> tuple[Import, ...]:
    """The import and load directives among the comments, in order."""
    found = ((comment, _IMPORT.fullmatch(comment.text)) for comment in comments)
    return tuple(
        Import(
            match["double"] or match["single"] or match["bare"],
            match["alias"] or "",
            comment.position,
        )
        for comment, match in found
        if match is not None
    )


def find_heading(comments: tuple[Comment, ...], key: str) -> str:
    """The value of ``grammar name …`` or ``grammar tier …``, the last one given, or nothing."""
    value = ""
    for comment in comments:
        match = _HEADING.fullmatch(comment.text)
        if match is not None and match["key"].lower() == key:
            value = match["value"]
    return value


def _place(line_starts: list[int], index: int, source: str) -> Position:
    line = bisect_right(line_starts, index)
    return Position(source, line, index - line_starts[line - 1] + 1)
