"""Verbs: join a world by the link of an invitation."""

from __future__ import annotations

from http import HTTPStatus

from django.contrib.auth.models import AnonymousUser
from django.db import IntegrityError, transaction

from annotations.language.texts import Refusal
from annotations.models import Invitation, User, World
from annotations.people.members import add_roles

MOST_PLACES = 200
MOST_DAYS = 60


class InvitationOver(Refusal):
    """Somebody else took the last place, or the invitation has expired or was withdrawn."""

    code = "invitation_over"
    status = HTTPStatus.NOT_FOUND

    def __init__(self) -> None:
        super().__init__("This invitation is over. Ask whoever sent it to you for another one.")


class NameTaken(Refusal):
    """An account of this name was made at the same moment."""

    code = "name_taken"
    status = HTTPStatus.CONFLICT

    def __init__(self) -> None:
        super().__init__("Somebody has this username already. Choose another one.")


def has_joined(invitation: Invitation, user: User) -> bool:
    """Return whether ``user`` has all that the invitation gives."""
    held = invitation.world.memberships.filter(user=user).values_list("role", flat=True)
    return set(invitation.roles) <= set(held)


def world_joined_by(key: str, user: User | AnonymousUser) -> World | None:
    """Return the world that ``user`` has joined, where ``key`` is of an invitation to it, open or over."""
    invitation = Invitation.objects.ever_made_with(key)
    if isinstance(user, AnonymousUser) or invitation is None or not has_joined(invitation, user):
        return None
    return invitation.world


@transaction.atomic
def join(invitation: Invitation, user: User) -> None:
    """Give ``user`` the roles of the invitation, which takes one of its places.

    Somebody who has them already takes none.

    Raises:
        InvitationOver: there is no place left, or it is no longer open.
    """
    rows = Invitation.objects.select_for_update(no_key=True).filter(pk=invitation.pk)
    held = rows.first()  # by one person at a time, who takes one place however often they ask
    if has_joined(invitation, user):
        return
    if held is None or not Invitation.objects.open().filter(pk=held.pk).exists():
        raise InvitationOver
    held.joined += 1
    held.save(update_fields=["joined"])
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
            if len(User.objects.alike(name)) > 1:
                raise NameTaken
    except IntegrityError as error:
        raise NameTaken from error
    return user
