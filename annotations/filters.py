"""What the lists of an annotated world may be filtered by. Each name is a parameter of the page's URL."""

from __future__ import annotations

from typing import Any

import django_filters
from django import forms
from django.db.models import Q, QuerySet
from django.http import HttpRequest

from annotations.language.symbols import ENTITY_CLASSES
from annotations.models import (
    Command,
    Entity,
    Example,
    LogicalForm,
    Paraphrase,
    Predicate,
    Production,
    SemanticTemplate,
)
from annotations.models.corpus import paraphrase_status_choices
from annotations.models.splits import part_choices, source_choices
from annotations.models.templates import template_status_choices

Choices = list[tuple[str, str]]


def predicate_choices(request: HttpRequest) -> Choices:
    """The predicates of the world that the page is about."""
    names = Predicate.objects.filter(world=request.world).values_list("name", flat=True)
    return [(name, name) for name in names]


def task_category_choices(request: HttpRequest) -> Choices:
    """The task categories that the world's commands are counted in."""
    rows = Command.objects.filter(world=request.world).order_by("task_category")
    names = rows.values_list("task_category", flat=True).distinct()
    return [(name, name) for name in names if name]


class PageFilters(django_filters.FilterSet):
    """Filters whose choices may depend on the world of the page: see ``world_choices``."""

    # Name of a filter → what gives its choices for a request.
    world_choices: dict[str, Any] = {}

    def __init__(self, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        for name, choices in self.world_choices.items():
            self.filters[name].extra["choices"] = choices(self.request)
        for each in self.filters.values():
            if isinstance(each, django_filters.ChoiceFilter):
                each.extra["empty_label"] = f"{each.label}: any"


class Search(django_filters.CharFilter):
    """A text somewhere in one of ``fields``, whatever its case."""

    def __init__(self, *fields: str, label: str = "Search"):
        super().__init__(label=label, widget=forms.SearchInput(attrs={"placeholder": label}))
        self.searched = fields

    def filter(self, rows: QuerySet[Any], value: str) -> QuerySet[Any]:
        condition = Q()
        for field in self.searched if value else ():
            condition |= Q(**{f"{field}__icontains": value})
        return rows.filter(condition)


class Head(django_filters.ChoiceFilter):
    """Forms in canonical corpus text that begin with a predicate."""

    def filter(self, rows: QuerySet[Any], value: str) -> QuerySet[Any]:
        return rows.filter(**{f"{self.field_name}__startswith": f"( {value} "}) if value else rows


class Mentions(django_filters.ChoiceFilter):
    """Forms in canonical corpus text that use a predicate anywhere."""

    def filter(self, rows: QuerySet[Any], value: str) -> QuerySet[Any]:
        return rows.filter(**{f"{self.field_name}__contains": f"( {value} "}) if value else rows


class EntityFilters(PageFilters):
    q = Search("text")
    entity_class = django_filters.ChoiceFilter(
        label="Class", choices=[(name, name) for name in ENTITY_CLASSES]
    )

    class Meta:
        model = Entity
        fields: list[str] = []


class TemplateFilters(PageFilters):
    q = Search("pattern", "form")
    source = django_filters.AllValuesFilter(label="File")
    status = django_filters.ChoiceFilter(label="Status", choices=template_status_choices)

    class Meta:
        model = SemanticTemplate
        fields: list[str] = []


class CommandFilters(PageFilters):
    q = Search("anonymized_text")
    task_category = django_filters.ChoiceFilter(label="Task category")
    head = django_filters.ChoiceFilter("logical_form__head_predicate", label="Head predicate")
    mentions = Mentions("logical_form__text", label="Predicate")
    in_grammar = django_filters.ChoiceFilter(
        "is_in_grammar",
        label="Grammar",
        choices=[("True", "in the grammar"), ("False", "outside it")],
    )
    template = django_filters.NumberFilter(
        "template_id", label="Template", widget=forms.HiddenInput
    )
    world_choices = {
        "task_category": task_category_choices,
        "head": predicate_choices,
        "mentions": predicate_choices,
    }

    class Meta:
        model = Command
        fields: list[str] = []


class CommandsOfFormFilters(PageFilters):
    q = Search("anonymized_text")
    task_category = django_filters.ChoiceFilter(label="Task category")
    world_choices = {"task_category": task_category_choices}

    class Meta:
        model = Command
        fields: list[str] = []


class FormFilters(PageFilters):
    q = Search("text")
    task_category = django_filters.ChoiceFilter(label="Task category")
    head = django_filters.ChoiceFilter("head_predicate", label="Head predicate")
    mentions = Mentions("text", label="Predicate")
    world_choices = {
        "task_category": task_category_choices,
        "head": predicate_choices,
        "mentions": predicate_choices,
    }

    class Meta:
        model = LogicalForm
        fields: list[str] = []


class ParaphraseFilters(PageFilters):
    q = Search("utterance", "prompt")
    status = django_filters.ChoiceFilter(label="Status", choices=paraphrase_status_choices)
    head = Head("logical_form", label="Head predicate")
    world_choices = {"head": predicate_choices}

    class Meta:
        model = Paraphrase
        fields: list[str] = []


class ExampleFilters(PageFilters):
    q = Search("utterance", "source_command")
    part = django_filters.ChoiceFilter(label="Part", choices=part_choices)
    source = django_filters.ChoiceFilter(label="Source", choices=source_choices)
    task_category = django_filters.ChoiceFilter(label="Task category")
    head = Head("logical_form", label="Head predicate")
    world_choices = {"task_category": task_category_choices, "head": predicate_choices}

    class Meta:
        model = Example
        fields: list[str] = []


class ProductionFilters(PageFilters):
    q = Search("nonterminal", "expansion")
    source = django_filters.AllValuesFilter(label="File")

    class Meta:
        model = Production
        fields: list[str] = []
