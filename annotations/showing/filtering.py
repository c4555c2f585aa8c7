"""Filters that lists are made of. Each name is a parameter of the page's URL."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import django_filters
from django import forms
from django.db.models import Exists, OuterRef, Q, QuerySet

from annotations.models import Command, Predicate, TaskCategory, World
from annotations.people.access import WorldRequest
from annotations.showing.paging import LARGEST_INTEGER

Choices = list[tuple[str, str]]


class ChoicesLater:
    """Choices that are looked up only when a form is shown or has a value to check."""

    def __init__(self, choices: Callable[[Any], Any], request: Any):
        self.choices = choices
        self.request = request
        self.known: list[Any] | None = None

    def __call__(self) -> list[Any]:
        if self.known is None:
            self.known = list(self.choices(self.request))
        return self.known

    def __deepcopy__(self, memo: Any) -> ChoicesLater:
        return self  # forms copy their fields, and a request cannot be copied


class PageFilters(django_filters.FilterSet):
    """Filters whose choices may depend on the world of the page: see ``world_choices``.

    The filters called ``further`` stand behind a button where pages show them.
    """

    # Name of a filter → what gives its choices for a request.
    world_choices: dict[str, Any] = {}
    further: tuple[str, ...] = ()

    def __init__(self, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        later = {each: ChoicesLater(each, self.request) for each in self.world_choices.values()}
        for name, choices in self.world_choices.items():
            self.filters[name].extra["choices"] = later[choices]
        for each in self.filters.values():
            if isinstance(each, django_filters.ChoiceFilter):
                each.extra.setdefault("empty_label", f"{each.label}: any")


class Search(django_filters.CharFilter):
    """A text somewhere in one of ``fields``, whatever its case."""

    def __init__(self, *fields: str, label: str = "Search"):
        super().__init__(label=label, widget=forms.SearchInput(attrs={"placeholder": label}))
        self.searched = fields

    def filter(self, rows: QuerySet[Any], value: str) -> QuerySet[Any]:
        return rows.filter(self.condition(value)) if value else rows

    def condition(self, value: str) -> Q:
        """Return the rows with ``value`` in any of the fields."""
        condition = Q()
        for field in self.searched:
            condition |= Q(**{f"{field}__icontains": value})
        return condition


class Key(django_filters.NumberFilter):
    """Rows that refer to another one, by its key."""

    field_class = forms.IntegerField

    def __init__(self, *args: Any, **kwargs: Any):
        super().__init__(*args, min_value=1, max_value=LARGEST_INTEGER, **kwargs)


class Head(django_filters.ChoiceFilter):
    """Forms in canonical corpus text that begin with a predicate."""

    def filter(self, rows: QuerySet[Any], value: str) -> QuerySet[Any]:
        return rows.filter(**{f"{self.field_name}__startswith": f"( {value} "}) if value else rows


class Mentions(django_filters.ChoiceFilter):
    """Forms in canonical corpus text that use a predicate anywhere."""

    def filter(self, rows: QuerySet[Any], value: str) -> QuerySet[Any]:
        return rows.filter(**{f"{self.field_name}__contains": f"( {value} "}) if value else rows


def predicate_choices(request: WorldRequest) -> Choices:
    """Return the predicates of the world that the page is about."""
    names = Predicate.objects.filter(world=request.world).values_list("name", flat=True)
    return [(name, name) for name in names]


def task_category_choices(request: WorldRequest) -> Choices:
    """Return the task categories of the world that the page is about."""
    return task_categories_with_commands(request.world)


def task_categories_with_commands(world: World) -> Choices:
    commands = Command.objects.filter(world=world, task_category=OuterRef("name"))
    rows = TaskCategory.objects.filter(Exists(commands), grammar__world=world)
    return [(name, name) for name in rows.order_by("name").values_list("name", flat=True)]
