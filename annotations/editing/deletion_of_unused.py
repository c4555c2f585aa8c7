"""Verbs: delete what nothing uses: a class of entities, or a primitive.

Each takes the row, who deletes it and the version that they saw. It raises Refusal where something of
its world uses it, and Overtaken where it is at another version or was deleted already.
"""

from __future__ import annotations

from collections.abc import Callable
from http import HTTPStatus

from django.db import transaction

from annotations.editing.edits import delete
from annotations.generation.class_uses import why_kept
from annotations.generation.recipe_check import why_primitive_is_kept
from annotations.language.texts import Refusal
from annotations.models import EntityClass, Primitive, User, World


def delete_class(row: EntityClass, by: User, version: int) -> None:
    _delete_unused(row, by, version, lambda: why_kept(row))


def delete_primitive(row: Primitive, by: User, version: int) -> None:
    _delete_unused(row, by, version, lambda: why_primitive_is_kept(row))


def _delete_unused(
    row: EntityClass | Primitive, by: User, version: int, why: Callable[[], str]
) -> None:
    with transaction.atomic():
        World.objects.hold().get(pk=row.world_id)  # nothing comes to use it from here on
        if reason := why():
            raise Refusal(reason, "in_use", HTTPStatus.CONFLICT)
        delete(row, by, version)
