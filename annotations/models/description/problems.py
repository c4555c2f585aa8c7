"""What a check found, stored beside what it is about."""

from __future__ import annotations

from django.db import models

from annotations.models.worlds import World


class Subject(models.TextChoices):
    ONTOLOGY = "ontology"
    GRAMMAR = "grammar"
    TEMPLATES = "templates"
    COMMANDS = "commands"
    PAIRS = "pairs"


def subject_choices() -> list[tuple[str, str]]:
    return Subject.choices


class StoredProblem(models.Model):
    """A warning: ``source:line:column: message (hint)``, about one part of a world."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="problems")
    subject = models.CharField(max_length=20, choices=subject_choices)
    source = models.CharField(max_length=200, blank=True)
    line = models.PositiveIntegerField(default=1)
    column = models.PositiveIntegerField(default=1)
    severity = models.CharField(max_length=10)
    message = models.TextField()
    hint = models.TextField(blank=True)

    class Meta:
        ordering = ["source", "line", "column", "id"]
        indexes = [models.Index(fields=["world", "subject"])]

    def __str__(self) -> str:
        return f"{self.source}:{self.line}:{self.column}: {self.message}"
