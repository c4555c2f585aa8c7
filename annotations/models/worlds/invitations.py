"""Links by which people join a world, with an account of theirs or a new one."""

from __future__ import annotations

import secrets
from datetime import timedelta

from django.db import models
from django.utils import timezone

from annotations.models.people import User, digest_of
from annotations.models.worlds.worlds import Role, World


class InvitationQuerySet(models.QuerySet["Invitation"]):
    def open(self) -> InvitationQuerySet:
        """Return those that somebody can still join by."""
        now = timezone.now()
        return self.filter(
            expires_at__gt=now,
            joined__lt=models.F("places"),
            created_by__is_active=True,
            world__deletion_requested_at__isnull=True,
        )

    def for_key(self, key: str) -> Invitation | None:
        """Return the open invitation whose link holds ``key``, or None."""
        if "\0" in key:
            return None
        rows = self.open().select_related("world", "created_by")
        return rows.filter(digest=digest_of(key)).first()


class Invitation(models.Model):
    """A link to a world that gives ``roles`` to as many people as it has ``places``, until it expires.

    The link's secret is shown once and stored only as its hash.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="invitations")
    roles = models.JSONField()
    note = models.CharField(max_length=80, blank=True)
    digest = models.CharField(max_length=64, unique=True)
    places = models.PositiveSmallIntegerField(default=1)
    joined = models.PositiveSmallIntegerField(default=0)
    created_by = models.ForeignKey(User, on_delete=models.CASCADE, related_name="invitations")
    created_at = models.DateTimeField(auto_now_add=True)
    expires_at = models.DateTimeField()

    objects = InvitationQuerySet.as_manager()

    class Meta:
        ordering = ["-created_at", "-pk"]

    def __str__(self) -> str:
        return f"invitation {self.pk} to {self.world}"

    @classmethod
    def issue(
        cls, world: World, roles: list[Role], by: User, days: int, places: int, note: str
    ) -> tuple[Invitation, str]:
        """Make an invitation and return it with the secret of its link, which is not kept."""
        key = secrets.token_urlsafe(32)
        invitation = cls.objects.create(
            world=world,
            roles=[str(role) for role in roles],
            note=note,
            digest=digest_of(key),
            places=places,
            created_by=by,
            expires_at=timezone.now() + timedelta(days=days),
        )
        return invitation, key
