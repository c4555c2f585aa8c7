"""Verbs: begin the grammar of an empty world, order its task categories, delete one."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus

from django.db import transaction

from annotations.editing.edits import add, delete
from annotations.generation.category_uses import why_category_is_kept
from annotations.generation.up_to_date import start_update
from annotations.language.texts import Refusal
from annotations.models import Grammar, TaskCategory, User, World
from annotations.rows.composition import new_category


def begin_grammar(world: World, name: str, by: User) -> None:
    """Give a world without task categories the first one; to be called in the transaction of its first row."""
    World.objects.hold().get(pk=world.pk)
    grammar, _ = Grammar.objects.get_or_create(world=world)
    if not grammar.task_categories.exists():
        add(new_category(grammar, name), by)


def order_categories(world: World, keys: Sequence[int], by: User) -> None:
    """Put the task categories into the order of ``keys``. A row that only moves is no new version.

    A command that two of them make belongs to the first. Raises Refusal unless ``keys`` are all of them.
    """
    with transaction.atomic():
        held = World.objects.hold().get(pk=world.pk)
        rows = {row.pk: row for row in TaskCategory.objects.filter(grammar__world=world)}
        if sorted(keys) != sorted(rows):
            said = (
                "The order names each task category once. Some were added or deleted; look again."
            )
            raise Refusal(said, "not_all_categories", HTTPStatus.CONFLICT)
        if list(keys) == list(rows):
            return
        for position, key in enumerate(keys):
            rows[key].position = position
        TaskCategory.objects.bulk_update(rows.values(), ["position"])
        held.mark_changed()
        start_update(held, by)


def delete_category(row: TaskCategory, by: User, version: int) -> None:
    """Delete a task category whose own sets are empty, or used by another one.

    Raises Refusal where they are not, and Overtaken where it is at another version or was deleted already.
    """
    with transaction.atomic():
        World.objects.hold().get(pk=row.owning_world.pk)
        if reason := why_category_is_kept(row):
            raise Refusal(reason, "in_use", HTTPStatus.CONFLICT)
        delete(row, by, version)
