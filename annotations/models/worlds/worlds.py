"""Worlds, and who may do what in them."""

from __future__ import annotations

from collections import defaultdict

from django.core.validators import RegexValidator
from django.db import models

from annotations.models.people import User


class Duty(models.TextChoices):
    """What somebody wants to do in a world. Each view, route and command names one."""

    VIEW = "view"
    ANNOTATE = "annotate"
    REVIEW = "review"
    MANAGE = "manage"


class Role(models.TextChoices):
    ANNOTATOR = "annotator"
    REVIEWER = "reviewer"
    ADMIN = "admin"


# Which duties a role carries. The one place for this rule.
DUTIES: dict[str, frozenset[Duty]] = {
    Role.ANNOTATOR: frozenset({Duty.VIEW, Duty.ANNOTATE}),
    Role.REVIEWER: frozenset({Duty.VIEW, Duty.REVIEW}),
    Role.ADMIN: frozenset(Duty),
}


class WorldQuerySet(models.QuerySet["World"]):
    def visible_to(self, user: User) -> WorldQuerySet:
        """Return the worlds that ``user`` is a member of; all of them for an administrator of the site."""
        if not user.is_authenticated:
            return self.none()
        worlds = self.present()
        return worlds if user.is_superuser else worlds.filter(memberships__user=user).distinct()

    def seen_by(self, user: User, name: str) -> tuple[World, frozenset[Duty]] | None:
        """Return the world called ``name`` with what ``user`` may do in it; None for who does not see it.

        One query: every request into a world begins with it.
        """
        if user.is_superuser:
            world = self.present().filter(name=name).first()
            return (world, world.duties_of(user)) if world else None
        as_member = self.present().filter(name=name, memberships__user=user)
        worlds = list(as_member.annotate(role=models.F("memberships__role")))
        if not worlds:
            return None
        roles = [world.role for world in worlds] if user.is_active else []
        return worlds[0], frozenset(duty for role in roles for duty in DUTIES[role])

    def present(self) -> WorldQuerySet:
        """Leave out those that are being deleted."""
        return self.filter(deletion_requested_at__isnull=True)

    def duties_by_world(self, user: User) -> dict[int, frozenset[Duty]]:
        """Return what ``user`` may do in each of these worlds, by key: ``World.duties_of`` in one query."""
        if user.is_superuser and user.is_active:
            return dict.fromkeys(self.values_list("pk", flat=True), frozenset(Duty))
        roles = self.filter(memberships__user=user).values_list("pk", "memberships__role")
        duties: dict[int, frozenset[Duty]] = defaultdict(frozenset)
        for world, role in roles if user.is_active else ():
            duties[world] |= DUTIES[role]
        return duties


class World(models.Model):
    """One ontology, grammar, set of predicates, templates, commands, paraphrases and splits.

    ``revision`` counts the changes of its grammar and of templates that make commands;
    ``generated_revision`` is the one that its commands were made from, ``generations`` how often
    they were. A world whose deletion was
    requested is shown to nobody, until its last row is gone.
    """

    name = models.CharField(
        max_length=60,
        unique=True,
        validators=[
            RegexValidator(r"^[a-z0-9][a-z0-9_-]*$", "Use lower-case letters, digits, _ and -.")
        ],
    )
    description = models.TextField(blank=True)
    created_at = models.DateTimeField(auto_now_add=True)
    revision = models.PositiveIntegerField(default=0, editable=False)
    generated_revision = models.PositiveIntegerField(default=0, editable=False)
    generations = models.PositiveIntegerField(default=0, editable=False)
    deletion_requested_at = models.DateTimeField(null=True, blank=True, editable=False)

    objects = WorldQuerySet.as_manager()

    class Meta:
        ordering = ["name"]

    def __str__(self) -> str:
        return self.name

    @property
    def commands_are_stale(self) -> bool:
        """Whether grammar or templates have changed since commands were last generated."""
        return self.generated_revision < self.revision

    def mark_changed(self) -> None:
        """Record a change of the grammar or of a template that makes commands."""
        World.objects.filter(pk=self.pk).update(revision=models.F("revision") + 1)

    def allows(self, user: User, duty: Duty) -> bool:
        """Return whether ``user`` may do ``duty`` here."""
        return duty in self.duties_of(user)

    def duties_of(self, user: User) -> frozenset[Duty]:
        """Return all that ``user`` may do here; nothing for outsiders and accounts that are switched off."""
        if not user.is_active:
            return frozenset()
        if user.is_superuser:
            return frozenset(Duty)
        roles = self.memberships.filter(user=user).values_list("role", flat=True)
        return frozenset(duty for role in roles for duty in DUTIES[role])


def role_choices() -> list[tuple[str, str]]:
    return Role.choices


class Membership(models.Model):
    """A role of a person in a world. A person may hold several."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="memberships")
    user = models.ForeignKey(User, on_delete=models.CASCADE, related_name="memberships")
    role = models.CharField(max_length=20, choices=role_choices)

    class Meta:
        constraints = [
            models.UniqueConstraint(fields=["world", "user", "role"], name="one_role_once")
        ]

    def __str__(self) -> str:
        return f"{self.user}: {self.role} in {self.world}"
