"""What the lists of a world's description may be filtered by. Each name is a parameter of the page's URL."""

from __future__ import annotations

import json
from typing import Any

import django_filters
from django import forms
from django.db.models import Count, Min, Q, QuerySet, TextField
from django.db.models.functions import Cast
from django.db.models.lookups import IContains

from annotations.models import Production, SemanticTemplate, TaskCategory, World
from annotations.models.description import (
    TemplateStatus,
    predicate_kind_choices,
    template_status_choices,
)
from annotations.people.access import WorldRequest
from annotations.rows.composition import split_entry
from annotations.rows.from_rows import classes_of
from annotations.showing.filtering import Choices, PageFilters, Search


def template_file_choices(request: WorldRequest) -> Choices:
    """Return the files and sets that the world's templates belong to."""
    rows = SemanticTemplate.objects.filter(grammar__world=request.world)
    return _sources_of(rows)


def grammar_file_choices(request: WorldRequest) -> Choices:
    """Return the files that the world's productions come from."""
    return _sources_of(Production.objects.filter(grammar__world=request.world))


def grammar_category_choices(request: WorldRequest) -> Choices:
    """Return the task categories of the world's grammar, whether they have commands or not."""
    rows = TaskCategory.objects.filter(grammar__world=request.world)
    return [(name, name) for name in rows.values_list("name", flat=True)]


def entity_class_choices(request: WorldRequest) -> Choices:
    """Return the classes of the world's entities."""
    return [(name, name) for name in classes_of(request.world).tokens]


def _sources_of(rows: QuerySet[Any]) -> Choices:
    names = rows.order_by("source").values_list("source", flat=True).distinct()
    return [(name, name) for name in names]


class EntitySearch(Search):
    """A text somewhere in the text or an alias of an entity."""

    # Between aliases in the column, which holds a JSON list.
    BETWEEN = frozenset("[],")

    def __init__(self) -> None:
        super().__init__("text")

    def condition(self, value: str) -> Q:
        condition = super().condition(value)
        if not self.BETWEEN.isdisjoint(value):
            return condition
        column = Cast("aliases", TextField())
        for written in {value, json.dumps(value)[1:-1]}:  # PostgreSQL's JSON, and SQLite's
            condition |= Q(IContains(column, written))
        return condition


class EntityFilters(PageFilters):
    q = EntitySearch()
    entity_class = django_filters.ChoiceFilter(label="Class")
    world_choices = {"entity_class": entity_class_choices}


class PredicateFilters(PageFilters):
    q = Search("name", "gloss")
    kind = django_filters.ChoiceFilter(label="Kind", choices=predicate_kind_choices)


class TemplateFilters(PageFilters):
    q = Search("pattern", "form")
    task_category = django_filters.ChoiceFilter(label="Task category")
    source = django_filters.ChoiceFilter(label="File")
    status = django_filters.ChoiceFilter(label="Status", choices=template_status_choices)
    problems = django_filters.ChoiceFilter(
        label="Problems",
        choices=[("yes", "with problems"), ("no", "without")],
        method="by_problems",
    )
    nonterminal = django_filters.CharFilter(
        label="Lines for", widget=forms.HiddenInput, method="by_nonterminal"
    )
    world_choices = {"task_category": grammar_category_choices, "source": template_file_choices}

    def by_nonterminal(self, rows: Any, name: str, value: str) -> Any:
        return rows.for_nonterminal(value.removeprefix("$"))

    def by_problems(self, rows: Any, name: str, value: str) -> Any:
        return rows.with_problems() if value == "yes" else rows.filter(problems=[])


class ProductionFilters(PageFilters):
    q = Search("nonterminal", "expansion")
    task_category = django_filters.ChoiceFilter(label="Task category", method="by_task_category")
    source = django_filters.ChoiceFilter(label="File")
    nonterminal = django_filters.CharFilter(label="Nonterminal", widget=forms.HiddenInput)
    world_choices = {"task_category": grammar_category_choices, "source": grammar_file_choices}

    def by_task_category(
        self, rows: QuerySet[Production], name: str, value: str
    ) -> QuerySet[Production]:
        """Return the productions that a task category is generated from, those of imported files too."""
        category = TaskCategory.objects.get(grammar__world=self.request.world, name=value)
        return rows.filter(source__in=[split_entry(entry)[0] for entry in category.rule_sources])


def with_counts(world: World) -> QuerySet[Any]:
    """Return the ready templates with how many of their commands are in the grammar and outside it."""
    is_outside = Q(commands__is_in_grammar=False)
    return SemanticTemplate.objects.filter(
        grammar__world=world, status=TemplateStatus.READY
    ).annotate(
        n_inside=Count("commands", filter=~is_outside & Q(commands__isnull=False)),
        n_outside=Count("commands", filter=is_outside),
        example=Min("commands__anonymized_text", filter=is_outside),
    )
