"""What the robot of a world calls its actions. ``parser_service.serving`` alone writes these rows."""

from __future__ import annotations

from django.db import models
from django.utils import timezone

from annotations.models import User, World


class ActionNames(models.Model):
    """The names of a world, all together, so that two people who edit them notice each other.

    ``names``: predicate, or ``ask_operator`` → ``{"name": …, "arguments": {argument: its name}}``.
    """

    world = models.OneToOneField(World, on_delete=models.CASCADE, related_name="action_names")
    names = models.JSONField(default=dict)
    version = models.PositiveIntegerField(default=1)
    changed_by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")
    changed_at = models.DateTimeField(default=timezone.now)

    class Meta:
        verbose_name_plural = "action names"

    def __str__(self) -> str:
        return f"Action names of {self.world}"
