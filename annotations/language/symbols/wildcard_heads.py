"""The head of a wildcard: ``kind? type id``, checked against the kinds and types that exist."""

from __future__ import annotations

import re
from dataclasses import dataclass
from difflib import get_close_matches

from annotations.language.symbols.cursor import Cursor
from annotations.language.symbols.symbols import ALIASES, TYPES

_WORD = re.compile(r"\w+")
_KEYWORD = re.compile(r"(where\b|meta\s*:)", re.IGNORECASE)
NAMES = (*TYPES, *ALIASES)


@dataclass(frozen=True, slots=True)
class WildcardHead:
    """The parts before ``where`` and ``meta``."""

    name: str
    type: str = ""
    id: int | None = None
    obfuscated: bool = False


def read_head(cursor: Cursor) -> WildcardHead:
    """Read ``kind[?] [type] [id]`` and stop before ``where``, ``meta:`` or the closing brace.

    Raises:
        LanguageError: an unknown kind, a type its kind does not have, or an id too long.
    """
    name = _read_name(cursor)
    cursor.skip_spaces()
    obfuscated = cursor.accept("?")
    type_ = ""
    identifier: int | None = None
    while (word := _next_word(cursor)) is not None:
        if word.isascii() and word.isdigit() and identifier is None and len(word) < 10:
            identifier = int(word)
        elif not type_ and word.lower() in TYPES.get(name, ()):
            type_ = word.lower()
        else:
            raise _unexpected(cursor, name, word)
        cursor.index += len(word)
    return WildcardHead(name, type_, identifier, obfuscated)


def _read_name(cursor: Cursor) -> str:
    cursor.skip_spaces()
    start = cursor.index
    word = cursor.match(_WORD)
    if word is None:
        raise cursor.fail("a wildcard needs a kind", f"one of {', '.join(NAMES)}")
    if word.lower() in NAMES:
        return word.lower()
    near = get_close_matches(word.lower(), NAMES, 1)
    hint = f"did you mean {{{near[0]}}}?" if near else f"the kinds are {', '.join(NAMES)}"
    raise cursor.fail(f"there is no wildcard {{{word}}}", hint, at=start)


def _next_word(cursor: Cursor) -> str | None:
    cursor.skip_spaces()
    if _KEYWORD.match(cursor.text, cursor.index):
        return None
    match = _WORD.match(cursor.text, cursor.index)
    return None if match is None else match.group()


def _unexpected(cursor: Cursor, name: str, word: str) -> Exception:
    types = TYPES.get(name, ())
    offer = f"its types are {', '.join(types)}" if types else f"{{{name}}} has no types"
    return cursor.fail(f"{word} is neither a type nor an id of {{{name}}}", offer)
