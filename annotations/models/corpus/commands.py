"""Commands and their logical forms."""

from __future__ import annotations

from django.db import models

from annotations.models.description import SemanticTemplate
from annotations.models.worlds import World


class LogicalForm(models.Model):
    """One meaning: ``text`` is canonical corpus notation. ``length`` counts tokens."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="logical_forms")
    text = models.TextField()
    head_predicate = models.CharField(max_length=80)
    depth = models.PositiveIntegerField()
    length = models.PositiveIntegerField()
    task_category = models.CharField(max_length=60, blank=True)

    class Meta:
        ordering = ["id"]
        constraints = [models.UniqueConstraint(fields=["world", "text"], name="form_text")]

    def __str__(self) -> str:
        return self.text


class Command(models.Model):
    """A generated, anonymized command; it belongs to the first task category that produces it."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="commands")
    template = models.ForeignKey(
        SemanticTemplate, null=True, on_delete=models.SET_NULL, related_name="commands"
    )
    logical_form = models.ForeignKey(LogicalForm, on_delete=models.CASCADE, related_name="commands")
    anonymized_text = models.TextField()
    length = models.PositiveIntegerField()
    task_category = models.CharField(max_length=60)
    is_in_grammar = models.BooleanField(default=True)
    position = models.PositiveIntegerField()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["world", "anonymized_text"], name="command_text")
        ]
        indexes = [models.Index(fields=["world", "task_category", "position"])]

    def __str__(self) -> str:
        return self.anonymized_text
