"""Worlds, and who may do what in them."""

from __future__ import annotations

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
        """The worlds that ``user`` is a member of; all of them for an administrator of the site."""
        if not user.is_authenticated:
            return self.none()
        return self if user.is_superuser else self.filter(memberships__user=user).distinct()


class World(models.Model):
    """One ontology, grammar, set of predicates, templates, commands, paraphrases and splits."""

    name = models.CharField(
        max_length=60,
        unique=True,
        validators=[
            RegexValidator(r"^[a-z0-9][a-z0-9_-]*$", "Use lower-case letters, digits, _ and -.")
        ],
    )
    description = models.TextField(blank=True)
    created_at = models.DateTimeField(auto_now_add=True)

    objects = WorldQuerySet.as_manager()

    class Meta:
        ordering = ["name"]

    def __str__(self) -> str:
        return self.name

    def allows(self, user: User, duty: Duty) -> bool:
        """Whether ``user`` may do ``duty`` here."""
        return duty in self.duties_of(user)

    def duties_of(self, user: User) -> frozenset[Duty]:
        """All that ``user`` may do here; nothing for outsiders and accounts that are switched off."""
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
