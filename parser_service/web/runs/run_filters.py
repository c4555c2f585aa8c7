"""What the list of runs may be filtered by; predictions: ``parser_service.results``."""

from __future__ import annotations

from decimal import Decimal

import django_filters
from django import forms
from django.db.models import Q, QuerySet

from annotations.models import Split
from annotations.people.access import WorldRequest
from annotations.showing.filtering import Choices, PageFilters, Search
from annotations.showing.paging import number_in
from parser_service.models import TrainingRun
from parser_service.models.runs import TrainingRunQuerySet, status_choices
from parser_service.parsers.registry import parsers


def parser_choices() -> Choices:
    return [(name, entry.title) for name, entry in parsers().items()]


def split_choices(request: WorldRequest) -> Choices:
    """Return the splits of the world that the page is about."""
    names = Split.objects.filter(world=request.world).values_list("name", flat=True)
    return [(name, name) for name in names]


class RunSearch(Search):
    """A run by its number, by its parser (registry name or title) or by its split."""

    def __init__(self) -> None:
        super().__init__("parser", "split__name")

    def filter(self, rows: QuerySet[TrainingRun], value: str) -> QuerySet[TrainingRun]:
        words = value.casefold()
        titled = [name for name, title in parser_choices() if words in title.casefold()]
        number = number_in(words.removeprefix("run").strip())
        by_number = Q(pk=number) if number else Q()
        condition = self.condition(value) | Q(parser__in=titled) | by_number
        return rows.filter(condition) if value else rows


class RunFilters(PageFilters):
    q = RunSearch()
    status = django_filters.ChoiceFilter(label="Status", choices=status_choices)
    parser = django_filters.ChoiceFilter(label="Parser", choices=parser_choices)
    split = django_filters.ChoiceFilter("split__name", label="Split")
    since = django_filters.ChoiceFilter(
        label="Same parser and split",
        choices=[("yes", "succeeded since"), ("no", "not succeeded since")],
        method="by_success_since",
    )
    seeds_of = django_filters.NumberFilter(
        label="Seeds of run", method="by_seeds_of", widget=forms.HiddenInput
    )
    world_choices = {"split": split_choices}

    def by_success_since(
        self, rows: TrainingRunQuerySet, name: str, value: str
    ) -> TrainingRunQuerySet:
        return rows.succeeded_since() if value == "yes" else rows.not_succeeded_since()

    def by_seeds_of(
        self, rows: TrainingRunQuerySet, name: str, value: Decimal
    ) -> TrainingRunQuerySet:
        """Return a run of this world and those that differ from it only by the seed."""
        run = self.request.world.runs.filter(pk=value).first()
        return rows.seeds_of(run) if run else rows.none()
