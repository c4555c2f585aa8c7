"""What a row of an archive must be before it is stored: archives come from anywhere."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from django.core.exceptions import ValidationError
from django.db import models

from annotations.exchange.archive_tables import ArchiveTable
from annotations.language.forms import is_token, read_template_form
from annotations.language.templates import SampleNote
from annotations.language.texts import LanguageError, Position, Refusal
from annotations.language.world import is_entity_kind
from annotations.models import Primitive, Recipe
from annotations.rows.column_values import as_json, from_json
from annotations.rows.stored_problems import is_stored_problems

Shapes = Mapping[str, Callable[[Any], bool]]

# Columns that name a file, by table; those that name one below a folder, as of a competition's; and those that
# hold a logical form.
FILE_PATHS = {"entities": ("source",)}
FILE_NAMES = {
    "productions": ("source",),
    "templates": ("source",),
}
FORMS = {
    "forms": ("text",),
    "campaign_prompts": ("logical_form", "grounded_form"),
    "paraphrases": ("logical_form", "grounded_form"),
    "utterances": ("logical_form",),
    "labels": ("form",),
    "audit_findings": ("form", "suggested_form", "decided_form"),
    "audit_reasons": ("suggested_form",),
    "audit_decisions": ("form",),
    "examples": ("logical_form", "grounded_form"),
}
# References that archives of earlier releases do not have, by table.
ADDED_REFERENCES = {"splits": {"follows"}, "paraphrases": {"contributor"}}


def parse_object(line: bytes, place: Position) -> dict[str, Any]:
    """Return the JSON object in ``line``. Raises LanguageError where it holds none, or text that no database takes."""
    try:
        values = json.loads(line.decode("utf-8"))
        text = json.dumps(values, ensure_ascii=False, allow_nan=False)
        text.encode("utf-8")
    except (ValueError, RecursionError) as error:
        raise LanguageError("this is not a line of JSON in UTF-8", place) from error
    if not isinstance(values, dict):
        raise LanguageError("this is not a JSON object", place)
    # Without the escaped backslashes: after one, "u0000" is text.
    if "\\u0000" in text.replace("\\\\", ""):
        raise LanguageError("the text has a NUL character", place)
    return values


def check_row(table: ArchiveTable, values: Mapping[str, Any], place: Position) -> None:
    """Raise LanguageError if a column is missing, unknown or of the wrong type.

    A column with a default may be missing: archives of earlier releases do not have it.
    """
    wanted = {each.name for each in table.columns} | {*table.references, *table.people}
    wanted |= {"subject"} if table.subjects else set()
    people = [table.model._meta.get_field(name) for name in table.people]
    optional = {
        each.name
        for each in (*table.columns, *people)
        if isinstance(each, models.Field) and each.has_default()
    }
    optional |= ADDED_REFERENCES.get(table.name, set())
    if wrong := (values.keys() - wanted) | (wanted - optional - values.keys()):
        names = ", ".join(sorted(wrong))
        raise LanguageError(f"these columns are missing or unknown: {names}", place)
    for column in table.columns:
        if column.name not in values:
            continue
        check_value(column, values[column.name], place, table.shapes or SHAPES)
    for name in table.people:
        if not isinstance(values.get(name), str | None):
            raise LanguageError(f"{name} is not the name of an account", place)
    if table.subjects and values["kind"] not in table.subjects:
        raise LanguageError(f"kind cannot be “{values['kind'][:40]}”", place)
    for name in FILE_NAMES.get(table.name, ()):
        _check_file_name(values[name], place)
    for name in FILE_PATHS.get(table.name, ()):
        for part in values[name].split("/"):
            _check_file_name(part, place)
    for name in FORMS.get(table.name, ()):
        if values[name] and not _is_form(values[name]):
            raise LanguageError(f"{name} is not a logical form", place)


def check_value(
    column: models.Field[Any, Any], value: Any, place: Position, shapes: Shapes | None = None
) -> None:
    """Raise LanguageError if ``column`` may not hold ``value``.

    ``shapes`` says what JSON columns may hold; by default, that of our own tables.
    """
    if value is None:
        if column.null:
            return
        raise LanguageError(f"{column.name} is missing", place)
    if isinstance(column, models.JSONField):
        if not (shapes or SHAPES)[column.name](value):
            raise LanguageError(f"{column.name} has the wrong shape", place)
        is_list_of_files = column.name in ("rule_sources", "template_sources")
        for name in value if is_list_of_files else ():
            _check_file_name(name, place)
        return
    try:
        read = from_json(column, value)
        # A number may be written whole; nothing else is read from another type of JSON.
        written = as_json(column, read)
        is_whole = isinstance(written, float) and type(value) is int
        if type(written) is not type(value) and not is_whole:
            raise LanguageError(f"{column.name} cannot be {str(value)[:40]}", place)
        if column.choices and value not in {choice for choice, _ in column.flatchoices}:
            raise LanguageError(f"{column.name} cannot be “{str(value)[:40]}”", place)
        column.run_validators(read)
    except ValidationError as error:
        raise LanguageError(f"{column.name}: {' '.join(error.messages)}", place) from error


def _check_file_name(name: str, place: Position) -> None:
    if "/" in name or "\\" in name or name.startswith("."):
        raise LanguageError(f"“{name[:40]}” is a path or a hidden file, not a file name", place)


@lru_cache(maxsize=50_000)
def _is_form(text: str) -> bool:
    try:
        read_template_form(text)
    except LanguageError:
        return False
    return True


def _is_texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(each, str) for each in value)


def _is_some_texts(value: Any) -> bool:
    return bool(value) and _is_texts(value)


def _is_text_by_text(value: Any) -> bool:
    return isinstance(value, dict) and _is_texts(list(value.values()))


def _is_signatures(value: Any) -> bool:
    """Return whether these are signatures. Whether the world has their classes is checked with its rows."""
    return isinstance(value, list) and all(
        _is_texts(row) and all(is_token(kind) or not is_entity_kind(kind) for kind in row)
        for row in value
    )


def _is_spans(value: Any) -> bool:
    """Return whether these are rows of [start, end, class, entity]."""
    return isinstance(value, list) and all(
        isinstance(row, list) and [type(each) for each in row] == [int, int, str, str]
        for row in value
    )


def _is_shares(value: Any) -> bool:
    """Return whether these are no shares, or three fractions of 1."""
    is_numbers = isinstance(value, list) and all(type(each) in (int, float) for each in value)
    return is_numbers and len(value) in (0, 3) and all(0 <= each <= 1 for each in value)


def _is_named(value: Any) -> bool:
    """Return whether these are entities of a prompt."""
    return isinstance(value, list) and all(
        isinstance(row, dict)
        and row.keys() == {"text", "aliases", "is_described"}
        and isinstance(row["text"], str)
        and _is_texts(row["aliases"])
        and isinstance(row["is_described"], bool)
        for row in value
    )


def _is_flags(value: Any) -> bool:
    """Return whether these are flags of a submission."""
    return isinstance(value, list) and all(
        _is_text_by_text(row) and row.keys() == {"code", "evidence"} for row in value
    )


def _is_settings(value: Any) -> bool:
    """Return whether these are settings of a model: names with texts or numbers."""
    of_types = (str, int, float, bool, type(None))
    return isinstance(value, dict) and all(isinstance(each, of_types) for each in value.values())


def _is_sample(value: Any) -> bool:
    """Return whether this is a note about a sample, or nothing."""
    try:
        SampleNote.from_json(value)
    except Refusal:
        return False
    return isinstance(value, dict)


SHAPES: Shapes = {
    "sample": _is_sample,
    "entities": _is_named,
    "flags": _is_flags,
    "settings": _is_settings,
    "aliases": _is_texts,
    "attributes": _is_text_by_text,
    "rule_sources": _is_some_texts,
    "template_sources": _is_some_texts,
    "signatures": _is_signatures,
    "problems": is_stored_problems,
    "spans": _is_spans,
    "proportions": _is_shares,
}


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
