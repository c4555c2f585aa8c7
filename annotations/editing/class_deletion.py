"""Verb: delete a class of entities that nothing uses."""

from __future__ import annotations

from http import HTTPStatus

from django.db import transaction

from annotations.editing.edits import delete
from annotations.generation.class_uses import why_kept
from annotations.language.texts import Refusal
from annotations.models import EntityClass, User, World


def delete_class(row: EntityClass, by: User, version: int) -> None:
    """Delete ``row``, which ``by`` saw at ``version``.

    Raises Refusal where every world has the class or something of its world uses it, and Overtaken where the
    row is at another version or was deleted already.
    """
    with transaction.atomic():
        World.objects.hold().get(pk=row.world_id)  # nothing uses it from here on
        if reason := why_kept(row):
            raise Refusal(reason, "in_use", HTTPStatus.CONFLICT)
        delete(row, by, version)
