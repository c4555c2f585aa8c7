"""Verb: delete a primitive that no recipe uses."""

from __future__ import annotations

from http import HTTPStatus

from django.db import transaction

from annotations.editing.edits import delete
from annotations.generation.recipe_check import why_primitive_is_kept
from annotations.language.texts import Refusal
from annotations.models import Primitive, User, World


def delete_primitive(row: Primitive, by: User, version: int) -> None:
    """Delete ``row``, which ``by`` saw at ``version``.

    Raises Refusal where a recipe uses it, and Overtaken where it is at another version or was deleted already.
    """
    with transaction.atomic():
        World.objects.hold().get(pk=row.world_id)  # no recipe comes to use it from here on
        if reason := why_primitive_is_kept(row):
            raise Refusal(reason, "in_use", HTTPStatus.CONFLICT)
        delete(row, by, version)
