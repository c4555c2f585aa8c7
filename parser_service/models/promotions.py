"""Which run is the learned part of what answers. ``parser_service.runs`` alone writes these rows."""

from __future__ import annotations

from django.db import models
from django.utils import timezone

from annotations.models import User, World
from annotations.models.short_texts import ShortTextField
from parser_service.models.runs import TrainingRun


class PromotionState(models.TextChoices):
    """``PROPOSED`` waits for an admin, who makes it ``PROMOTED`` or ``DECLINED``; ``OVERTAKEN``: another
    run was proposed or promoted meanwhile."""

    PROPOSED = "proposed", "proposed"
    PROMOTED = "promoted", "promoted"
    DECLINED = "declined", "declined"
    OVERTAKEN = "overtaken", "overtaken"


def promotion_state_choices() -> list[tuple[str, str]]:
    return PromotionState.choices


class PromotionQuerySet(models.QuerySet["Promotion"]):
    def promoted(self) -> PromotionQuerySet:
        """Return those that took place, the last one first."""
        done = self.filter(state=PromotionState.PROMOTED)
        return done.order_by("-decided_at", "-pk")

    def present(self) -> PromotionQuerySet:
        """Return the last one of each world: its run is the learned part there, unless its parser learns nothing."""
        of_world = Promotion.objects.promoted().filter(world=models.OuterRef("world"))
        return self.filter(pk=models.Subquery(of_world.values("pk")[:1]))

    def proposed(self) -> PromotionQuerySet:
        """Return those that wait for an admin."""
        return self.filter(state=PromotionState.PROPOSED)

    def overtake(self, by: User | None) -> None:
        """Decide that another run takes their place; ``by`` is None where a rule decides."""
        self.update(state=PromotionState.OVERTAKEN, decided_at=timezone.now(), decided_by=by)


class Promotion(models.Model):
    """A run that is the learned part of what answers in its world from ``decided_at`` on, until the next one; or one
    proposed for it.

    ``evidence`` holds the scores of the run and of the one before it, as they were then:
    ``{"run": [score, …], "before": {"run": key, "scores": [score, …]} or null}``, where a score has
    ``test_source``, ``part``, ``count``, ``accuracy``, ``low`` and ``high``. ``decided_by`` is None for
    what a rule decided.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="promotions")
    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="promotions")
    state = models.CharField(max_length=10, choices=promotion_state_choices)
    reason = ShortTextField(max_length=500, blank=True)
    evidence = models.JSONField(default=dict)
    made_at = models.DateTimeField(default=timezone.now)
    decided_at = models.DateTimeField(null=True, blank=True)
    decided_by = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)

    objects = PromotionQuerySet.as_manager()

    class Meta:
        ordering = ["-id"]
        indexes = [models.Index(fields=["world", "state", "-decided_at"])]

    def __str__(self) -> str:
        return f"{self.run} in {self.world}: {self.state}"
