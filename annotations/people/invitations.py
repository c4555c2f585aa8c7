"""Verbs: join a world by the link of an invitation."""

from __future__ import annotations

from django.db import IntegrityError, transaction
from django.db.models import F

from annotations.models import Invitation, User
from annotations.people.members import add_roles

MOST_PLACES = 200
MOST_DAYS = 60


class InvitationOver(ValueError):
    """Somebody else took the last place, or the invitation has expired or was withdrawn."""

    def __init__(self) -> None:
        super().__init__("This invitation is over. Ask whoever sent it to you for another one.")


class NameTaken(ValueError):
    """An account of this name was made at the same moment."""

    def __init__(self) -> None:
        super().__init__("A user with that username already exists.")


def has_joined(invitation: Invitation, user: User) -> bool:
    """Return whether ``user`` has all that the invitation gives."""
    held = invitation.world.memberships.filter(user=user).values_list("role", flat=True)
    return set(invitation.roles) <= set(held)


@transaction.atomic
def join(invitation: Invitation, user: User) -> None:
    """Give ``user`` the roles of the invitation, which takes one of its places.

    Somebody who has them already takes none.

    Raises:
        InvitationOver: there is no place left, or it is no longer open.
    """
    if has_joined(invitation, user):
        return
    # One conditional update, so that two people cannot take the last place.
    rows = Invitation.objects.filter(pk=invitation.pk, joined__lt=F("places"))
    if not Invitation.objects.open().filter(pk=invitation.pk).exists() or not rows.update(
        joined=F("joined") + 1
    ):
        raise InvitationOver
    add_roles(invitation.world, user, invitation.roles)


def sign_up(invitation: Invitation, name: str, password: str) -> User:
    """Create the account ``name`` and let it join; neither happens without the other.

    Raises:
        InvitationOver: as ``join`` does.
        NameTaken: the name is no longer free.
    """
    try:
        with transaction.atomic():
            user = User.objects.create_user(name, password=password)
            join(invitation, user)
    except IntegrityError as error:
        raise NameTaken from error
    return user
