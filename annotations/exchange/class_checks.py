"""Whether the rows of an archive keep to the classes of entities that it has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from annotations.language.forms import EntityClasses, kinds_in_form, kinds_in_pattern, require_token
from annotations.language.texts import LanguageError, Position, Problem
from annotations.language.world import known_kinds
from annotations.models.description import TemplateStatus


def check_token(token: str, place: Position) -> None:
    """Raise LanguageError unless a class can have this token."""
    try:
        require_token(token)
    except LanguageError as error:
        raise LanguageError(error.message, place, error.hint) from error


def check_classes(
    table: str, values: Mapping[str, Any], classes: EntityClasses, place: Position
) -> None:
    """Raise LanguageError where a row of ``table`` names a class that is not one of ``classes``.

    A template that is not ready may say anything.
    """
    if table == "entities" and values["entity_class"] not in classes:
        named = values["entity_class"][:40]
        raise LanguageError(f"entity_class cannot be “{named}”, which is no class here", place)
    elif table == "predicates":
        kinds = known_kinds(classes)
        for kind in (kind for each in values["signatures"] for kind in each):
            if kind not in kinds:
                raise LanguageError(f"signatures cannot have the kind “{kind[:40]}”", place)
    for problem in _unknown_wildcards(table, values, classes):
        raise LanguageError(problem.message, place, problem.hint)


def _unknown_wildcards(
    table: str, values: Mapping[str, Any], classes: EntityClasses
) -> Iterator[Problem]:
    if table == "productions":
        yield from kinds_in_pattern(values["expansion"], classes, Position())
    elif table == "templates" and values.get("status") == TemplateStatus.READY:
        yield from kinds_in_pattern(values["pattern"], classes, Position())
        yield from kinds_in_form(values["form"], classes, Position())
