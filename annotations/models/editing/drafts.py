"""What somebody has typed and not saved yet."""

from __future__ import annotations

from django.db import models

from annotations.models.people import User
from annotations.models.worlds import World

NEW = "new"


class Draft(models.Model):
    """The fields of a form about one row, as their author left them; nobody else sees them.

    ``subject`` is the key of the row; for a new one ``NEW``, or that with a dash and a name behind it.
    ``base_version`` is the version that is edited, None for a new row. ``device`` tells the browsers of
    one person apart.
    """

    user = models.ForeignKey(User, on_delete=models.CASCADE, related_name="drafts")
    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="drafts")
    kind = models.CharField(max_length=20)
    subject = models.CharField(max_length=20)
    fields = models.JSONField(default=dict)
    base_version = models.PositiveIntegerField(null=True)
    device = models.CharField(max_length=40)
    saved_at = models.DateTimeField()

    class Meta:
        constraints = [
            models.UniqueConstraint(
                fields=["user", "world", "kind", "subject"], name="one_draft_each"
            )
        ]

    def __str__(self) -> str:
        return f"draft of {self.user}: {self.kind} {self.subject}"
