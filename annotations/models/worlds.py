"""Worlds, who may do what in them, and who did what."""

from __future__ import annotations

import secrets
from collections import defaultdict
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any

from django.conf import settings
from django.contrib.auth.models import AnonymousUser
from django.core.validators import RegexValidator
from django.db import models
from django.utils import timezone

from annotations.models.people import User, digest_of
from annotations.models.short_texts import ShortTextField

if TYPE_CHECKING:
    from annotations.language.forms import EntityClasses
    from annotations.language.templates import SampleNote, SampleRequest
    from annotations.language.world import Predicate


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
    def visible_to(self, user: User | AnonymousUser) -> WorldQuerySet:
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
        with_role = as_member.annotate(role=models.F("memberships__role"))  # type: ignore[no-redef]  # declared for readers
        worlds = list(with_role)
        if not worlds:
            return None
        roles = [world.role for world in worlds] if user.is_active else []
        return worlds[0], frozenset(duty for role in roles for duty in DUTIES[role])

    def hold(self) -> WorldQuerySet:
        """Lock the worlds until the transaction ends, for one writer at a time.

        Rows that refer to a world, such as an entry of the audit log, need not wait: the key of a held world stays.
        """
        return self.select_for_update(no_key=True)

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
    they were. ``sample`` is a ``SampleNote`` as JSON where a sample was asked for, else empty. A world whose
    deletion was requested is shown to nobody, until its last row is gone.
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
    sample = models.JSONField(default=dict, blank=True, editable=False)
    deletion_requested_at = models.DateTimeField(null=True, blank=True, editable=False)

    if TYPE_CHECKING:
        role: str  # where ``WorldQuerySet.seen_by`` annotates it
        declared: dict[str, Predicate]  # where ``form_presentation`` keeps them
        classes: EntityClasses

    # Whether a new one has no classes of entities and no recipes: it is begun by hand, or by files that bring them.
    is_bare = False

    objects = WorldQuerySet.as_manager()

    class Meta:
        ordering = ["name"]

    def __str__(self) -> str:
        return self.name

    def save(self, *args: Any, **kwargs: Any) -> None:
        """Store the world; a new one with a household's classes of entities and recipes unless it ``is_bare``."""
        is_new = self._state.adding
        super().save(*args, **kwargs)
        if is_new and not self.is_bare:
            from annotations.language.plans import default_book

            self.entity_classes.add_of_household(self)
            self.primitives.start_book(self, default_book())
            self.recipes.start_book(self, default_book())

    @property
    def commands_are_stale(self) -> bool:
        """Whether grammar or templates have changed since commands were last generated."""
        return self.generated_revision < self.revision

    @property
    def sample_note(self) -> SampleNote | None:
        """What to say of the commands; None where they are all that the templates make."""
        from annotations.language.templates import SampleNote

        note = SampleNote.from_json(self.sample)
        return None if note is None or note.is_all else note

    @property
    def sample_request(self) -> SampleRequest:
        """What somebody asked for when the commands were last made."""
        from annotations.language.templates import EVERYTHING, SampleNote

        note = SampleNote.from_json(self.sample)
        return EVERYTHING if note is None else note.request

    @property
    def most_of_a_template(self) -> int | None:
        """How many commands a template may make before it is left out; None where a sample is drawn."""
        from annotations.language.templates import DEFAULT_LIMIT

        return None if self.sample_request.size else DEFAULT_LIMIT

    @property
    def awaits_first_commands(self) -> bool:
        """Whether there are templates and none of them has made a command yet."""
        return (
            self.commands_are_stale
            and not self.commands.exists()
            and hasattr(self, "grammar")
            and self.grammar.templates.exists()
        )

    @property
    def has_commands_to_generate(self) -> bool:
        """Whether a generation would make commands, or make those anew that are here."""
        return self.commands_are_stale and (self.commands.exists() or self.awaits_first_commands)

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


class InvitationQuerySet(models.QuerySet["Invitation"]):
    def open(self) -> InvitationQuerySet:
        """Return those that somebody can still join by: who sent them is an admin still."""
        now = timezone.now()
        admins = Membership.objects.filter(
            world=models.OuterRef("world"), user=models.OuterRef("created_by"), role=Role.ADMIN
        )
        return self.filter(
            models.Q(created_by__is_superuser=True) | models.Exists(admins),
            expires_at__gt=now,
            joined__lt=models.F("places"),
            created_by__is_active=True,
            world__deletion_requested_at__isnull=True,
        )

    def withdraw(self) -> dict[int, datetime]:
        """End those that can still be joined by, and return until when each would have been open, by key."""
        ends = dict(self.filter(expires_at__gt=timezone.now()).values_list("pk", "expires_at"))
        self.filter(pk__in=ends).update(expires_at=timezone.now())
        return ends

    def for_key(self, key: str) -> Invitation | None:
        """Return the open invitation whose link holds ``key``, or None."""
        return self.open().ever_made_with(key)

    def ever_made_with(self, key: str) -> Invitation | None:
        """Return the invitation whose link holds ``key``, also one that is over, or None."""
        if "\0" in key:
            return None
        rows = self.filter(world__deletion_requested_at__isnull=True, digest=digest_of(key))
        return rows.select_related("world", "created_by").first()


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
        constraints = [
            models.CheckConstraint(
                condition=models.Q(joined__lte=models.F("places")), name="places_of_an_invitation"
            )
        ]

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


class AuditEntry(models.Model):
    """Something that somebody did over a page, the API or the command line. It outlives person and world.

    ``subject`` names the row, as ``template 12``, or says in short what was done; ``through`` is the
    name of the token that a program used. No value that somebody typed as a secret stands here.
    """

    world = models.ForeignKey(
        World, null=True, on_delete=models.SET_NULL, related_name="audit_entries"
    )
    world_name = models.CharField(max_length=60, blank=True)
    who = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+"
    )
    who_name = models.CharField(max_length=150)
    through = ShortTextField(max_length=80, blank=True)
    what = ShortTextField(max_length=80)
    subject = ShortTextField(max_length=200, blank=True)
    at = models.DateTimeField(default=timezone.now)

    class Meta:
        ordering = ["-pk"]
        indexes = [models.Index(fields=["world", "-id"], name="audit_of_world")]

    def __str__(self) -> str:
        return f"{self.who_name}: {self.what} {self.subject}".rstrip()
