"""The world that an import goes into."""

from __future__ import annotations

from contextlib import suppress

from django.core.exceptions import ValidationError
from django.db import IntegrityError, transaction

from annotations.language.texts import LanguageError
from annotations.models import Membership, User, World
from annotations.models.worlds import Role


def require_world_name(name: str) -> None:
    """Raise LanguageError if no world can have this name."""
    try:
        World(name=name).clean_fields()
    except ValidationError as error:
        sentences = " ".join(error.messages)
        raise LanguageError(f"“{name}” cannot be the name of a world: {sentences}") from error


def lock_world(name: str, by: User | None = None, is_bare: bool = False) -> World:
    """Return the world, and make it if there is none. Lock it, so that a second import waits for this one.

    To be called inside a transaction. ``by`` becomes the admin of a world that this makes; one that ``is_bare`` has no
    classes of entities yet.
    """
    world = World.objects.hold().filter(name=name).first()
    if world is not None:
        return world
    made = World(name=name)
    made.is_bare = is_bare
    with (
        suppress(IntegrityError),
        transaction.atomic(),
    ):  # another import may have made it meanwhile
        made.save()
        if by is not None:
            Membership.objects.create(world=made, user=by, role=Role.ADMIN)
    return World.objects.hold().get(name=name)
