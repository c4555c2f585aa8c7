"""What a filter of a world's lists may be set to, as its rows say."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import HttpRequest

from annotations.models import Command, Predicate, Production, SemanticTemplate, TaskCategory

Choices = list[tuple[str, str]]


def predicate_choices(request: HttpRequest) -> Choices:
    """Return the predicates of the world that the page is about."""
    names = Predicate.objects.filter(world=request.world).values_list("name", flat=True)
    return [(name, name) for name in names]


def task_category_choices(request: HttpRequest) -> Choices:
    """Return the task categories that the world's commands are counted in."""
    rows = Command.objects.filter(world=request.world).order_by("task_category")
    names = rows.values_list("task_category", flat=True).distinct()
    return [(name, name) for name in names if name]


def template_file_choices(request: HttpRequest) -> Choices:
    """Return the files and sets that the world's templates belong to."""
    rows = SemanticTemplate.objects.filter(grammar__world=request.world)
    return _sources_of(rows)


def grammar_file_choices(request: HttpRequest) -> Choices:
    """Return the files that the world's productions come from."""
    return _sources_of(Production.objects.filter(grammar__world=request.world))


def grammar_category_choices(request: HttpRequest) -> Choices:
    """Return the task categories of the world's grammar, whether they have commands or not."""
    rows = TaskCategory.objects.filter(grammar__world=request.world)
    return [(name, name) for name in rows.values_list("name", flat=True)]


def _sources_of(rows: QuerySet[Any]) -> Choices:
    names = rows.order_by("source").values_list("source", flat=True).distinct()
    return [(name, name) for name in names]


def member_choices(request: HttpRequest) -> Choices:
    """Return the people who have a role in the world."""
    rows = request.world.memberships.order_by("user__username")
    return [(str(key), name) for key, name in rows.values_list("user", "user__username").distinct()]
