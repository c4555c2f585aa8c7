"""Limits on the length, nesting and characters of texts, for the readers and the database."""

from __future__ import annotations

import re

from annotations.language.texts.errors import LanguageError, Offsets, Position

# Nesting of brackets, forms and XML elements: readers recurse, so this stays far below Python's limit.
MAX_NESTING = 64

# Characters of a name.
MAX_FILE_NAME = 200
MAX_TASK_CATEGORY = 60
MAX_NONTERMINAL = 120
MAX_PREDICATE = 80
MAX_GLOSS = 200
MAX_ENTITY = 500

# Characters of the pattern of a template, and of a logical form wherever it is written.
MAX_PATTERN = 5_000
MAX_FORM = 5_000
# Characters of a row of a recipe book.
MAX_ROW = 1_000
# Bytes of a command or a canonical form: a PostgreSQL index refuses rows above 2,704.
MAX_INDEXED_BYTES = 2_500

# Characters that neither a database nor a text file can hold.
_UNWRITABLE = re.compile(r"[\x00-\x08\x0e-\x1f\x7f\ud800-\udfff\ufffe\uffff]")


def require_name(name: str, what: str, longest: int, position: Position) -> None:
    """Raise LanguageError if ``name`` has more than ``longest`` characters.

    ``what`` is the word for it in the message: "predicate", "nonterminal", …
    """
    if len(name) > longest:
        raise LanguageError(
            f"the {what} {name[:20]}… has {len(name):,} characters",
            position,
            f"{longest} is the limit; choose a shorter name",
        )


def require_length(text: str, what: str, longest: int, position: Position) -> None:
    """Raise LanguageError if ``text`` has more than ``longest`` characters; ``what`` is the word for it."""
    if len(text) > longest:
        raise LanguageError(
            f"the {what} has {len(text):,} characters", position, f"{longest:,} is the limit"
        )


def require_writable(text: str, position: Position) -> None:
    """Raise LanguageError at a control character or half of a surrogate pair."""
    match = _UNWRITABLE.search(text)
    if match is not None:
        place = Offsets(text, position.source).position(match.start())
        column = place.column + (position.column - 1 if place.line == 1 else 0)
        raise LanguageError(
            f"the character U+{ord(match[0]):04X} is not allowed here",
            Position(position.source, position.line + place.line - 1, column),
            "remove it",
        )
