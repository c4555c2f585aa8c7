"""Verb: add the classes of entities of a household to a world that was begun without them."""

from __future__ import annotations

from django.db import transaction

from annotations.editing.edits import add_many
from annotations.models import EntityClass, User, World


def add_household(world: World, by: User) -> int:
    """Add those classes of GPSRCmdGen that ``world`` has not got, and return how many that were."""
    with transaction.atomic():
        held = World.objects.hold().get(pk=world.pk)
        return add_many(EntityClass.objects.missing_of_household(held), by)
