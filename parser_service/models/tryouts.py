"""Texts that people try on runs. ``parser_service.reviews`` alone writes these rows."""

from __future__ import annotations

from typing import Any

from django.db import models
from django.utils import timezone

from annotations.models import User, World


class TryoutQuerySet(models.QuerySet["Tryout"]):
    def waiting(self) -> TryoutQuerySet:
        """Return those that some run has not answered, the longest waiting first."""
        return self.filter(is_answered=False).order_by("asked_at")


class Tryout(models.Model):
    """The text that a person tries in a world now, and what the chosen runs answer to it.

    There is one row for each person and world, so that the newest text takes the place of the one before;
    ``number`` grows with each. ``runs`` are the keys of the runs, and ``answers`` maps such a key, as text,
    to ``{"answers": [{"form": …, "score": …, "is_cut": …}, …]}`` or ``{"problem": sentence}``. ``before`` is the last
    text that was answered, with its answers.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="tryouts")
    person = models.ForeignKey(User, on_delete=models.CASCADE, related_name="tryouts")
    number = models.PositiveIntegerField(default=0)
    text = models.TextField(blank=True)
    runs = models.JSONField(default=list)
    answers = models.JSONField(default=dict)
    before = models.JSONField(default=dict, blank=True)
    is_answered = models.BooleanField(default=True)
    asked_at = models.DateTimeField(default=timezone.now)

    objects = TryoutQuerySet.as_manager()

    class Meta:
        constraints = [
            models.UniqueConstraint(fields=["world", "person"], name="one_tryout_of_each_person")
        ]

    def __str__(self) -> str:
        return self.text

    @property
    def open_runs(self) -> list[int]:
        """The runs that have not answered."""
        return [run for run in self.runs if str(run) not in self.answers]

    def as_before(self) -> dict[str, Any]:
        """Return the text and its answers as ``before`` keeps them."""
        return {"text": self.text, "answers": self.answers}
