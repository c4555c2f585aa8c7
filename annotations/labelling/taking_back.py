"""Verbs: take back what lines given as examples have made of a world, with their upload; all of it or nothing.

The history of each row that they added or changed names the upload.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

from django.db import transaction
from django.db.models import Model, Q

from annotations.editing.edits import change_many, delete_many, restore
from annotations.generation.class_uses import why_kept
from annotations.language.texts import Refusal, say_count
from annotations.models import (
    Editable,
    Entity,
    EntityClass,
    Predicate,
    Production,
    SemanticTemplate,
    TaskCategory,
    Upload,
    User,
    World,
)
from annotations.rows.history import ADDED, DELETED, history_of
from annotations.rows.row_kinds import kind_of_model

# In the order in which they are deleted: what uses others comes first.
MODELS: tuple[type[Editable], ...] = (
    *(SemanticTemplate, Production, TaskCategory, Predicate, Entity, EntityClass),
)


class StillUsed(Refusal):
    """Something that came with an upload was changed since, or something else depends on it."""

    code = "in_use"
    status = HTTPStatus.CONFLICT


@dataclass(frozen=True, slots=True)
class Brought:
    """What came with an upload: rows that it added, and what it has made of others, with what they were."""

    added: dict[type[Editable], list[Any]]
    changed: list[tuple[Editable, dict[str, Any]]]
    others: list[str]  # rows that are not as the upload has left them

    @property
    def counts(self) -> str:
        """What would be taken back, as part of a sentence; empty where there is nothing."""
        said = [
            say_count(len(rows), kind_of_model(model).singular)
            for model, rows in reversed(self.added.items())
            if rows
        ]
        longer = [say_count(len(self.changed), "changed line")] if self.changed else []
        return ", ".join([*said, *longer])


def reason_of(upload: Upload) -> str:
    """Return what the history of a row says that came with an upload."""
    return f"upload {upload.pk}"


def brought_by(upload: Upload) -> Brought:
    """Return what is still there of what came with an upload."""
    brought = Brought({}, [], [])
    for model in MODELS:
        entries = history_of(model).filter(history_change_reason=reason_of(upload))
        rows = model._default_manager.in_bulk([entry.id for entry in entries])
        brought.added[model] = []
        for entry in entries.order_by("history_id"):
            if (row := rows.get(entry.id)) is None:
                continue
            if _values(row) != _values(entry.instance):
                brought.others.append(str(row))
            elif entry.history_type == ADDED:
                brought.added[model].append(row)
            else:
                earlier = history_of(model).filter(id=row.pk, history_id__lt=entry.history_id)
                before = earlier.exclude(history_type=DELETED).order_by("-history_id").first()
                if _values(before.instance) != _values(row):
                    brought.changed.append((row, _values(before.instance)))
    return brought


def why_not(upload: Upload) -> str:
    """Return sentences about why ``take_back`` would refuse; empty where it would not."""
    brought = brought_by(upload)
    if brought.others:
        return f"{_some(brought.others)} changed since."
    return " ".join(_dependants(upload.world, brought))


def take_back(upload: Upload, by: User) -> None:
    """Delete the rows that came with an upload, and make those that it has changed what they were.

    Raises StillUsed where one of them was changed since, or something else depends on one.
    """
    with transaction.atomic():
        world = World.objects.hold().get(pk=upload.world_id)
        if reason := why_not(upload):
            raise StillUsed(reason)
        brought = brought_by(upload)
        change_many(world, brought.changed, by, _undone(upload))
        delete_many(world, list(brought.added.values()), by, _undone(upload))


def bring_again(upload: Upload, by: User) -> None:
    """Bring back what ``take_back`` took. Raises ValidationError where another row says the same by now."""
    with transaction.atomic():
        World.objects.hold().get(pk=upload.world_id)
        for model in reversed(MODELS):
            entries = history_of(model).filter(history_change_reason=reason_of(upload))
            for entry in entries.order_by("history_id"):
                last = history_of(model).filter(id=entry.id).order_by("-history_id").first()
                if last.history_change_reason == _undone(upload):
                    restore(entry, by)


def _undone(upload: Upload) -> str:
    return f"{reason_of(upload)} undone"


def _values(row: Any) -> dict[str, Any]:
    return {name: getattr(row, name) for name in row.edited_fields}


def _some(names: list[str]) -> str:
    shown = ", ".join(f"“{name}”" for name in names[:3])
    more = f" and {len(names) - 3:,} more" if len(names) > 3 else ""
    return f"{shown}{more} {'was' if len(names) == 1 else 'were'}"


def _dependants(world: World, brought: Brought) -> Iterator[str]:
    """Yield a sentence for each row that would go, and that something else needs."""
    taken: dict[type[Model], set[int]] = {
        model: {row.pk for row in rows} for model, rows in brought.added.items()
    }
    for row, _ in brought.changed:  # what it says now, it no longer says then
        taken[type(row)].add(row.pk)
    productions = Production.objects.filter(grammar__world=world)
    templates = SemanticTemplate.objects.filter(grammar__world=world)
    productions = productions.exclude(pk__in=taken[Production])
    templates = templates.exclude(pk__in=taken[SemanticTemplate])
    defined = set(productions.values_list("nonterminal", flat=True))
    for name in sorted({each.nonterminal for each in brought.added[Production]} - defined):
        says = rf"\${re.escape(name)}([^a-zA-Z0-9_]|$)"
        if (
            productions.filter(expansion__regex=says).exists()
            or templates.filter(Q(pattern__regex=says) | Q(form__regex=says)).exists()
        ):
            yield f"Other lines of the grammar or the templates say ${name}."
    for predicate in brought.added[Predicate]:
        uses = rf"\(\s*{re.escape(predicate.name)}([^a-zA-Z0-9_]|$)"
        if templates.filter(form__regex=uses).exists():
            yield f"Other templates use {predicate.name}."
        if world.recipes.filter(action=predicate.name).exists():
            yield f"A recipe is for {predicate.name}."
    for category in brought.added[TaskCategory]:
        if any(
            rows.filter(task_category=category.name).exists() for rows in (productions, templates)
        ):
            yield f"Other lines belong to the task category {category.name}."
    for row in brought.added[EntityClass]:
        if reason := why_kept(row, taken):
            yield reason
