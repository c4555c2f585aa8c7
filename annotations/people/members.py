"""Verbs: give people roles in a world, and take them away."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime
from http import HTTPStatus

from django.db import transaction

from annotations.language.texts import Refusal
from annotations.models import Assignment, Invitation, Membership, User, World
from annotations.models.worlds import Role


class NoAdminLeft(Refusal):
    """The change would leave the world without an admin."""

    code = "no_admin_left"
    status = HTTPStatus.CONFLICT

    def __init__(self, world: World) -> None:
        super().__init__(
            f"{world} needs an admin. Make somebody else an admin before you take this role away."
        )


@dataclass(frozen=True, slots=True)
class Member:
    """A person and all their roles in one world, in the order of ``Role``."""

    user: User
    roles: tuple[str, ...]


def role_names(roles: Collection[str]) -> str:
    """Return roles as a sentence says them, such as ``annotator and reviewer``."""
    return " and ".join(role for role in Role.values if role in roles)


def members_of(world: World) -> list[Member]:
    """Return everybody who has a role in ``world``, by name. One query."""
    rows = world.memberships.select_related("user").order_by("user__username")
    roles: dict[User, set[str]] = {}
    for row in rows:
        roles.setdefault(row.user, set()).add(row.role)
    return [
        Member(user, tuple(role for role in Role.values if role in held))
        for user, held in roles.items()
    ]


def roles_of(world: World, user: User) -> list[str]:
    """Return the roles of ``user`` in ``world``, in the order of ``Role``."""
    held = set(world.memberships.filter(user=user).values_list("role", flat=True))
    return [role for role in Role.values if role in held]


def admins_of(world: World) -> list[str]:
    """Return the names of the world's admins who can log in."""
    admins = world.memberships.filter(role=Role.ADMIN, user__is_active=True)
    return list(admins.order_by("user__username").values_list("user__username", flat=True))


def find_account(name: str) -> User | None:
    """Return the account called ``name`` that can log in, or None."""
    account = User.objects.named(name)
    return account if account is not None and account.is_active else None


@transaction.atomic
def set_roles(world: World, user: User, roles: Collection[str], by: User) -> dict[int, datetime]:
    """Make ``roles`` the roles of ``user`` in ``world``; none removes them from it.

    Whoever is no longer an admin has no invitations open any more, and what they held in the work queue
    and may not do any more is free for others. Returns the invitations that are over with it, as
    ``Invitation.objects.withdraw`` does.

    Raises:
        NoAdminLeft: the last admin would lose that role. Administrators of the site, who see every
            world, may do that all the same.
    """
    World.objects.hold().get(pk=world.pk)
    world.memberships.filter(user=user).exclude(role__in=roles).delete()
    add_roles(world, user, roles)
    if not admins_of(world) and not by.is_superuser:
        raise NoAdminLeft(world)
    withdrawn: dict[int, datetime] = {}
    if Role.ADMIN not in roles and not user.is_superuser:
        withdrawn = Invitation.objects.filter(world=world, created_by=user).withdraw()
    Assignment.objects.orphaned().filter(person=user, item__world=world).release()
    return withdrawn


def add_roles(world: World, user: User, roles: Collection[str]) -> int:
    """Give ``user`` these roles in ``world`` beside those that they have. Return how many are new."""
    made = (
        Membership.objects.get_or_create(world=world, user=user, role=Role(role))[1]
        for role in roles
    )
    return sum(made)
