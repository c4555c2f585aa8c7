"""Semantic templates: what annotators write."""

from __future__ import annotations

from typing import Any

from django.db import models

from annotations.models.description.grammar import Grammar, TaskCategory
from annotations.models.editing import Editable
from annotations.models.people import User


class TemplateStatus(models.TextChoices):
    DRAFT = "draft"
    READY = "ready"
    DISPUTED = "disputed"


def template_status_choices() -> list[tuple[str, str]]:
    return TemplateStatus.choices


class SemanticTemplateQuerySet(models.QuerySet["SemanticTemplate"]):
    def with_problems(self) -> SemanticTemplateQuerySet:
        """Return the templates that the checker had something to say about when they were last stored."""
        return self.exclude(problems=[])


class SemanticTemplate(Editable):
    """``pattern = form``: a partial expansion of the grammar and the logical form of its commands.

    ``source`` is the file or set it belongs to; ``task_category`` the category that set was written for.
    ``imported_text`` is the line that it was imported as, by which a later import knows it whatever
    people have made of it since; empty for one that a person wrote here. ``problems`` are what the
    checker said when it was last stored, as ``annotations.rows.template_problems`` writes them.
    """

    world_path = "grammar__world"
    edited_fields = ("task_category", "source", "pattern", "form", "status")
    fields_beside = ("problems",)
    bears_on_commands = True

    grammar = models.ForeignKey(Grammar, on_delete=models.CASCADE, related_name="templates")
    source = models.CharField(max_length=200)
    line = models.PositiveIntegerField(default=0)
    task_category = models.CharField(max_length=60, blank=True)
    pattern = models.TextField()
    form = models.TextField()
    imported_text = models.TextField(blank=True)
    status = models.CharField(
        max_length=20, choices=template_status_choices, default=TemplateStatus.READY
    )
    author = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    position = models.PositiveIntegerField()
    problems = models.JSONField(default=list, blank=True)

    objects = SemanticTemplateQuerySet.as_manager()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["grammar", "position"], name="template_position")
        ]

    def __str__(self) -> str:
        return f"{self.pattern} = {self.form}"

    @classmethod
    def for_category(cls, category: TaskCategory, **values: Any) -> SemanticTemplate:
        """Return an unsaved template with ``values`` in the set that ``category`` calls its own."""
        return cls(grammar=category.grammar, **cls.set_of(category), **values)

    @staticmethod
    def set_of(category: TaskCategory) -> dict[str, str]:
        """Return the fields that put a template into the set that ``category`` calls its own."""
        return {"source": category.template_sources[-1], "task_category": category.name}

    def moved_to(self, category: TaskCategory | None) -> dict[str, str]:
        """Return the fields that change when the template moves to ``category``.

        None do where it is there already, or in a set that belongs to no task category.
        """
        stays = category is None or self.task_category in ("", category.name)
        return {} if stays else self.set_of(category)

    @property
    def makes_commands(self) -> bool:
        return self.status == TemplateStatus.READY

    def note_editor(self, by: User) -> None:
        self.author = by
