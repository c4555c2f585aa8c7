"""Comments of a grammar file, and the directives that live in them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from annotations.language.errors import LanguageError, Offsets, Position

# In this order: an escaped character, a block, an unclosed block, a comment to the end of the line.
_COMMENT = re.compile(
    r"\\.|(?P<block>/\*.*?\*/)|(?P<open>/\*)|(?P<line>(?:[#;%]|//)[^\n]*)", re.DOTALL
)
_LINE_SIGN = re.compile(r"[#;%]|//")
_PATH = r"""(?:"(?P<double>[^"]+)"|'(?P<single>[^']+)'|(?P<bare>\S+))"""
_IMPORT = re.compile(rf"(?:import|load)\s+{_PATH}(?:\s+as\s+\$(?P<alias>\w+))?\s*", re.IGNORECASE)
_HEADING = re.compile(r"grammar\s+(?P<key>name|tier)\s+(?P<value>.+?)\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Comment:
    """The text of one comment, without its sign."""

    text: str
    position: Position


@dataclass(frozen=True, slots=True)
class Import:
    """``; import path`` or ``; import path as $alias``."""

    path: str
    alias: str
    position: Position


def split_comments(text: str, source: str) -> tuple[str, tuple[Comment, ...]]:
    """Take the comments out of a grammar file.

    Returns:
        The text with spaces where comments stood, so that lines and columns keep their numbers,
        and the comments in order.

    Raises:
        LanguageError: a ``/*`` that is never closed.
    """
    comments: list[Comment] = []
    offsets = Offsets(text, source)

    def blank(match: re.Match[str]) -> str:
        if match["block"] is None and match["open"] is None and match["line"] is None:
            return match.group()
        place = offsets.position(match.start())
        if match["open"]:
            raise LanguageError(
                "the comment opened here is never closed", place, "close it with */"
            )
        words = match["block"][2:-2] if match["block"] else _LINE_SIGN.sub("", match["line"], 1)
        comments.append(Comment(words.strip(), place))
        return re.sub(r"[^\n]", " ", match.group())

    return _COMMENT.sub(blank, text), tuple(comments)


def find_imports(comments: tuple[Comment, ...]) -> tuple[Import, ...]:
    """Return the import and load directives among the comments, in order."""
    matches = ((comment, _IMPORT.fullmatch(comment.text)) for comment in comments)
    return tuple(
        Import(
            match["double"] or match["single"] or match["bare"],
            match["alias"] or "",
            comment.position,
        )
        for comment, match in matches
        if match is not None
    )


def find_heading(comments: tuple[Comment, ...], key: str) -> str:
    """Return the last value of ``grammar name …`` or ``grammar tier …``, or an empty string."""
    value = ""
    for comment in comments:
        match = _HEADING.fullmatch(comment.text)
        if match is not None and match["key"].lower() == key:
            value = match["value"]
    return value
