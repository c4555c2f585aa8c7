"""The audit log: who did what, to what, and when."""

from __future__ import annotations

from django.conf import settings
from django.db import models
from django.utils import timezone

from annotations.models.worlds.worlds import World


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
    through = models.CharField(max_length=80, blank=True)
    what = models.CharField(max_length=80)
    subject = models.CharField(max_length=200, blank=True)
    at = models.DateTimeField(default=timezone.now)

    class Meta:
        ordering = ["-pk"]
        indexes = [models.Index(fields=["world", "-id"], name="audit_of_world")]

    def __str__(self) -> str:
        return f"{self.who_name}: {self.what} {self.subject}".rstrip()
