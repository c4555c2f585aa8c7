"""Conversations about commands, and the entities that came up in them.

``parser_service.serving`` alone writes these rows.
"""

from __future__ import annotations

from typing import Any

from django.db import models
from django.utils import timezone

from annotations.models import User, Utterance, World
from annotations.models.corpus import MOST_CHARACTERS
from parser_service.models.runs import TrainingRun


class Dialogue(models.Model):
    """A command and what was said until nothing of it was open.

    ``state`` is what ``annotations.language.plans.State`` writes, ``phase`` that of the state;
    ``transcript`` holds ``{"who": "person" or "robot", "text": …}`` in order. ``utterance`` is the one that the form is
    of: the last one, where the first was said another way. ``version`` grows with each answer.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="dialogues")
    utterance = models.CharField(max_length=MOST_CHARACTERS)
    state = models.JSONField()
    phase = models.CharField(max_length=12)
    transcript = models.JSONField(default=list)
    run = models.ForeignKey(TrainingRun, null=True, on_delete=models.SET_NULL, related_name="+")
    kept_as = models.ForeignKey(
        Utterance, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    started_by = models.ForeignKey(
        User, null=True, on_delete=models.SET_NULL, related_name="dialogues"
    )
    started_at = models.DateTimeField(default=timezone.now)
    version = models.PositiveIntegerField(default=1)

    class Meta:
        ordering = ["-id"]
        indexes = [models.Index(fields=["world", "-id"])]

    def __str__(self) -> str:
        return self.utterance

    @property
    def is_over(self) -> bool:
        return self.phase in ("done", "cancelled")

    @property
    def prompt(self) -> str:
        """What the robot said last."""
        return str(self.state["prompt"])


class OfferState(models.TextChoices):
    """What became of an entity that somebody named in a dialogue."""

    WAITING = "waiting", "waiting"
    CONFIRMED = "confirmed", "confirmed"
    REFUSED = "refused", "refused"


def offer_state_choices() -> list[tuple[str, str]]:
    return OfferState.choices


class OfferedEntity(models.Model):
    """An entity that a dialogue offers for the ontology, or another word (``alias``) for one that is there.

    An annotator confirms or refuses it. A world has each offer once; ``times`` counts how often it came up.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="offered_entities")
    entity_class = models.CharField(max_length=20)
    text = models.CharField(max_length=500)
    alias = models.CharField(max_length=500, blank=True)
    said_in = models.CharField(max_length=MOST_CHARACTERS)
    times = models.PositiveIntegerField(default=1)
    state = models.CharField(max_length=10, choices=offer_state_choices, default=OfferState.WAITING)
    offered_at = models.DateTimeField(default=timezone.now)
    decided_by = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    decided_at = models.DateTimeField(null=True, blank=True)

    class Meta:
        ordering = ["-id"]
        constraints = [
            models.UniqueConstraint(
                fields=["world", "entity_class", "text", "alias"], name="one_offer_of_each_entity"
            )
        ]
        indexes = [
            models.Index(fields=["world", "state", "-id"]),
            models.Index(fields=["world", "-decided_at"], name="offers_by_decision"),
        ]

    def __str__(self) -> str:
        return f"{self.alias} (= {self.text})" if self.alias else self.text

    def as_json(self) -> dict[str, Any]:
        return {"entity_class": self.entity_class, "text": self.text, "alias": self.alias}
