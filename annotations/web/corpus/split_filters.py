"""What splits and their examples may be filtered by, and how much of their figures is shown at once."""

from __future__ import annotations

import django_filters

from annotations.models.splits import part_choices, source_choices
from annotations.showing.filtering import (
    Head,
    PageFilters,
    Search,
    predicate_choices,
    task_category_choices,
)

MOST_SHOWN = 100
MOST_CHANGES = 20  # labels that the page of a split shows before and after


class ExampleFilters(PageFilters):
    q = Search("utterance", "source_command")
    part = django_filters.ChoiceFilter(label="Part", choices=part_choices)
    source = django_filters.ChoiceFilter(label="Source", choices=source_choices)
    task_category = django_filters.ChoiceFilter(label="Task category")
    head = Head("logical_form", label="Head predicate")
    world_choices = {"task_category": task_category_choices, "head": predicate_choices}


class SplitFilters(PageFilters):
    q = Search("name")
