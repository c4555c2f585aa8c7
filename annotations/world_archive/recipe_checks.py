"""Whether the rows of an archive belong into a recipe book."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from annotations.language.errors import LanguageError, Position
from annotations.models import Primitive, Recipe


def check_book_row(
    model: type[Primitive | Recipe], values: Mapping[str, Any], place: Position
) -> None:
    """Raise LanguageError where a row of an archive cannot be read, or where its columns do not fit its text."""
    try:
        columns = model.columns_of(values["text"])
    except LanguageError as error:
        raise LanguageError(error.message, place, error.hint) from error
    for name, value in columns.items():
        if values[name] != value:
            raise LanguageError(f"{name} is not “{value[:40]}”, as the text says", place)
