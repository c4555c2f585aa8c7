"""Semantic templates: what annotators write."""

from __future__ import annotations

from django.db import models

from annotations.models.grammar import Grammar
from annotations.models.people import User


class Status(models.TextChoices):
    DRAFT = "draft"
    READY = "ready"
    DISPUTED = "disputed"


def template_status_choices() -> list[tuple[str, str]]:
    return Status.choices


class SemanticTemplate(models.Model):
    """``pattern = form``: a partial expansion of the grammar and the logical form of its commands.

    ``source`` is the file or set it belongs to; ``task_category`` the category that set was written for.
    ``imported_text`` is the line that it was imported as, by which a later import knows it whatever
    people have made of it since; empty for one that a person wrote here.
    """

    grammar = models.ForeignKey(Grammar, on_delete=models.CASCADE, related_name="templates")
    source = models.CharField(max_length=200)
    line = models.PositiveIntegerField(default=0)
    task_category = models.CharField(max_length=60, blank=True)
    pattern = models.TextField()
    form = models.TextField()
    imported_text = models.TextField(blank=True)
    status = models.CharField(max_length=20, choices=template_status_choices, default=Status.READY)
    author = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    version = models.PositiveIntegerField(default=1)
    position = models.PositiveIntegerField()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["grammar", "position"], name="template_position")
        ]

    def __str__(self) -> str:
        return f"{self.pattern} = {self.form}"
