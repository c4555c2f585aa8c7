"""Verb: take back a change of who is in a world, as the button “Undo” in its message asks for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from http import HTTPStatus

from django.core import signing
from django.db import transaction
from django.utils import timezone

from annotations.language.texts import Refusal
from annotations.models import Invitation, User, World
from annotations.people.members import role_names, roles_of, set_roles

SALT = "annotations.people.taking_back"
LONGEST_SECONDS = 24 * 60 * 60  # that a message offers it


class CannotTakeBack(Refusal):
    """The change is not the last one any more, or nobody can say what it was."""

    code = "cannot_take_back"
    status = HTTPStatus.CONFLICT


@dataclass(frozen=True, slots=True)
class PeopleChange:
    """What was done: the roles of somebody ``before`` and ``after``, and the invitations that ended.

    ``withdrawn`` says until when each invitation would have been open, by key. Without a ``member`` invitations alone
    were withdrawn. ``at`` is a moment after all that.
    """

    world: World
    member: User | None = None
    before: Sequence[str] = ()
    after: Sequence[str] = ()
    withdrawn: Mapping[int, datetime] = field(default_factory=dict)
    at: datetime = field(default_factory=timezone.now)

    def sealed(self) -> str:
        """Write the change as a text that nobody can make up, to be sent back by the button."""
        ends = {str(key): until.isoformat() for key, until in self.withdrawn.items()}
        member = self.member.pk if self.member else None
        values = [
            self.world.pk,
            member,
            list(self.before),
            list(self.after),
            ends,
            self.at.isoformat(),
        ]
        return signing.dumps(values, salt=SALT, compress=True)

    @classmethod
    def read(cls, sealed: str, world: World) -> PeopleChange:
        """Read what ``sealed`` wrote about ``world``. Raises CannotTakeBack."""
        try:
            values = signing.loads(sealed, salt=SALT, max_age=LONGEST_SECONDS)
        except signing.BadSignature as error:
            raise CannotTakeBack("This can no longer be undone.") from error
        of_world, key, before, after, ends, at = values
        member = User.objects.filter(pk=key).first() if key else None
        if of_world != world.pk or (key and member is None):
            raise CannotTakeBack("This can no longer be undone.")
        withdrawn = {int(each): datetime.fromisoformat(until) for each, until in ends.items()}
        return cls(world, member, before, after, withdrawn, datetime.fromisoformat(at))


@transaction.atomic
def take_back_people_change(change: PeopleChange, by: User) -> str:
    """Make it as it was before ``change``, and return a sentence about it.

    Raises:
        CannotTakeBack: somebody has changed the roles since, or the invitation is open or was withdrawn once more.
        NoAdminLeft: the last admin would lose that role.
    """
    World.objects.hold().get(pk=change.world.pk)
    said = "The invitation is open again."
    if member := change.member:
        if roles_of(change.world, member) != list(change.after):
            raise CannotTakeBack(
                f"Nothing was undone: somebody has changed the roles of {member} in the meantime."
            )
        set_roles(change.world, member, change.before, by)
        said = f"{member} is {role_names(change.before)} of {change.world} again."
        if not change.before:
            said = f"{member} is no longer a member of {change.world}."
    over_since = Invitation.objects.filter(world=change.world, expires_at__lte=change.at)
    opened = sum(
        over_since.filter(pk=key).update(expires_at=until)
        for key, until in change.withdrawn.items()
    )
    if not change.member and not opened:
        raise CannotTakeBack(
            "Nothing was undone: the invitation is open already, or was withdrawn once more."
        )
    return said
