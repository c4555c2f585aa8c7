"""Where somebody lands who logs in and has asked for no page."""

from __future__ import annotations

from django.contrib.auth.models import AnonymousUser
from django.urls import reverse

from annotations.models import User, World


def landing_page_of(user: User | AnonymousUser) -> str:
    """Return the address of the only world of somebody who has one; others choose from the list."""
    worlds = World.objects.visible_to(user)[:2]
    return reverse("world", args=[worlds[0].name]) if len(worlds) == 1 else reverse("home")
