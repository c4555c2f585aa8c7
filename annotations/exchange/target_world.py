"""The world that an import goes into."""

from __future__ import annotations

from django.core.exceptions import ValidationError

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


def lock_world(name: str, by: User | None = None) -> World:
    """Return the world, and make it if there is none. Lock it, so that a second import waits for this one.

    To be called inside a transaction. ``by`` becomes the admin of a world that this makes.
    """
    world, is_new = World.objects.hold().get_or_create(name=name)
    if is_new and by is not None:
        Membership.objects.create(world=world, user=by, role=Role.ADMIN)
    return world
