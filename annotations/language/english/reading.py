"""Reads the word lists: TOML files beside this module, or a team's own in their place.

A folder named by the environment variable ``GPSR_ENGLISH_DIR`` may hold files of the same names. Such a file
replaces the whole of the one here.
"""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

VARIABLE = "GPSR_ENGLISH_DIR"
_KINDS: dict[type, str] = {str: "text", list: "list", dict: "table"}
_OURS = Path(__file__).resolve().parent / "data"


class EnglishError(ValueError):
    """A file of word lists cannot be used. Says which file, what is wrong, and what is expected."""


class WordFile:
    """One file of word lists, read when it is made.

    Raises EnglishError: the file is no TOML; what is asked for is missing or of another shape.
    """

    def __init__(self, name: str) -> None:
        folder = Path(os.environ.get(VARIABLE) or _OURS)
        own = folder / f"{name}.toml"
        self._path = own if own.is_file() else _OURS / own.name
        try:
            self._values = tomllib.loads(self._path.read_text(encoding="utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise EnglishError(f"{self._path} is no TOML file: {error}.") from error

    def text(self, key: str) -> str:
        """Return a text."""
        return self._text(key, self._get(key))

    def expression(self, key: str) -> re.Pattern[str]:
        """Return a regular expression."""
        try:
            return re.compile(self.text(key))
        except re.error as error:
            raise EnglishError(
                f"{self._path}: “{key}” is no regular expression: {error}."
            ) from error

    def words(self, key: str) -> tuple[str, ...]:
        """Return a list of texts, in the order of the file."""
        return self._words(key, self._get(key))

    def groups(self, key: str) -> tuple[tuple[str, ...], ...]:
        """Return a list of lists of texts."""
        return tuple(self._words(key, each) for each in self._checked(key, self._get(key), list))

    def texts_by_name(self, key: str) -> dict[str, str]:
        """Return a table of texts."""
        return self._texts(key, self._get(key))

    def words_by_name(self, key: str) -> dict[str, tuple[str, ...]]:
        """Return a table of lists of texts."""
        return {name: self._words(key, each) for name, each in self._table(key).items()}

    def tables_by_name(self, key: str) -> dict[str, dict[str, str]]:
        """Return a table of tables of texts."""
        return {name: self._texts(key, each) for name, each in self._table(key).items()}

    def choices_by_name(self, key: str) -> dict[str, tuple[str | Mapping[str, str], ...]]:
        """Return a table of lists, each item a text or a table of texts."""
        return {
            name: tuple(
                each if isinstance(each, str) else self._texts(key, each)
                for each in self._checked(key, items, list)
            )
            for name, items in self._table(key).items()
        }

    def tables(self, key: str) -> Sequence[Mapping[str, Any]]:
        """Return a list of tables of texts and lists."""
        return [self._checked(key, each, dict) for each in self._checked(key, self._get(key), list)]

    def _get(self, key: str) -> Any:
        if key not in self._values:
            raise EnglishError(
                f"{self._path} has no “{key}”. A file that replaces a word list needs all that the "
                f"original has: see {_OURS / self._path.name}."
            )
        return self._values[key]

    def _table(self, key: str) -> dict[str, Any]:
        table: dict[str, Any] = self._checked(key, self._get(key), dict)
        return table

    def _texts(self, key: str, value: Any) -> dict[str, str]:
        table = self._checked(key, value, dict)
        return {name: self._text(key, each) for name, each in table.items()}

    def _text(self, key: str, value: Any) -> str:
        text: str = self._checked(key, value, str)
        return text

    def _words(self, key: str, value: Any) -> tuple[str, ...]:
        return tuple(self._text(key, each) for each in self._checked(key, value, list))

    def _checked(self, key: str, value: Any, kind: type) -> Any:
        if not isinstance(value, kind):
            raise EnglishError(
                f"{self._path}: under “{key}”, {value!r} stands where a {_KINDS[kind]} is expected. "
                f"{_OURS / self._path.name} shows how."
            )
        return value
