"""What a slice of predictions may be chosen by: one filter each, by its name in the URL."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from django import forms
from django.db.models import QuerySet

from annotations.models.splits import part_choices, source_choices
from annotations.people.access import WorldRequest
from annotations.showing.filtering import (
    Choices,
    PageFilters,
    predicate_choices,
    task_category_choices,
)
from parser_service.models import Prediction, TrainingRun
from parser_service.results.filter_conditions import FilterCondition
from parser_service.results.filter_kinds import (
    NO_CATEGORY,
    AnswerForm,
    AnswerHead,
    CategoryFilter,
    ChoiceFilter,
    OpenChoiceFilter,
    OutcomeFilter,
    SavedSlice,
    SeenFilter,
    SlotFilter,
    UtteranceSearch,
    VersusRun,
    WholeNumber,
)

OUTCOMES = [
    ("correct", "correct"),
    ("wrong", "wrong"),
    ("equivalent", "equivalent only"),
    ("same_plan", "same plan"),
    ("only_plan", "same plan only"),
    ("other_plan", "another plan"),
    ("malformed", "malformed"),
    ("none", "no answer"),
]
SEEN = [("seen", "seen in training"), ("new", "not seen in training")]


def head_choices(request: WorldRequest) -> Choices:
    return [*predicate_choices(request), ("UNKNOWN", "UNKNOWN")]


def category_choices(request: WorldRequest) -> Choices:
    """Return the error categories of the world, and that of answers nobody has put into one."""
    names = request.world.error_categories.values_list("code", "name")
    return [*names, (NO_CATEGORY, "not categorised")]


def slice_choices(request: WorldRequest) -> Choices:
    """Return the saved slices of the world."""
    return [(str(key), name) for key, name in request.world.slices.values_list("pk", "name")]


class PredictionFilters(PageFilters):
    """Chooses first answers by their example, by what they are, and by what reviews say of them.

    ``category_by`` refines ``category``, and ``versus_outcome`` what the run ``versus`` made of the same example.
    ``of_run`` is the run of all rows where they are of one, which makes some filters quick.
    A page may add filters of its own; those without ``demand`` filter its rows, and are in no slice.
    """

    q = UtteranceSearch("example__utterance")
    outcome = OutcomeFilter(label="Outcome", choices=OUTCOMES)
    part = ChoiceFilter("example__part", label="Part", choices=part_choices)
    source = ChoiceFilter("example__source", label="Source", choices=source_choices)
    task_category = OpenChoiceFilter("example__task_category", label="Task category")
    head = OpenChoiceFilter("example__head_predicate", label="Head predicate")
    category = CategoryFilter(label="Error category")
    category_by = ChoiceFilter(
        label="Categorised by",
        choices=[("people", "people"), ("machine", "the machine")],
        is_refinement=True,
    )
    slice = SavedSlice(label="Slice")
    min_words = WholeNumber("example__word_count", "gte", label="Words, at least")
    max_words = WholeNumber("example__word_count", "lte", label="Words, at most")
    min_depth = WholeNumber("example__depth", "gte", label="Depth of the form, at least")
    max_depth = WholeNumber("example__depth", "lte", label="Depth of the form, at most")
    answer = SeenFilter("answer_in_training", label="Answer", choices=SEEN)
    label = SeenFilter("label_in_training", label="Label", choices=SEEN)
    answer_head = AnswerHead(label="Head predicate of the answer")
    answer_form = AnswerForm(label="Answer is", widget=forms.HiddenInput)
    slot = SlotFilter(label="Slot", widget=forms.HiddenInput)
    versus = VersusRun(label="Other run", widget=forms.HiddenInput)
    versus_outcome = ChoiceFilter(
        label="Other run is",
        choices=OUTCOMES,
        widget=forms.HiddenInput,
        is_refinement=True,
    )
    world_choices = {
        "task_category": task_category_choices,
        "head": head_choices,
        "answer_head": head_choices,
        "category": category_choices,
        "slice": slice_choices,
    }
    further: tuple[str, ...] = (
        *("category_by", "min_words", "max_words", "min_depth", "max_depth"),
        *("answer", "label", "answer_head"),
    )

    def __init__(self, *args: Any, of_run: TrainingRun | None = None, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.of_run = of_run

    def conditions(self, but: Collection[str] = ()) -> list[FilterCondition]:
        """Return what the given filters demand, except for those called ``but``. Values that a filter does
        not know are left out."""
        given = self.given
        demands = (
            self.filters[name].demand(value, given)
            for name, value in given.items()
            if name not in but and hasattr(self.filters[name], "demand")
        )
        return [condition for condition in demands if condition is not None]

    def filter_queryset(self, queryset: QuerySet[Prediction]) -> QuerySet[Prediction]:
        for condition in self.conditions():
            queryset = queryset.filter(condition.rows)
        for name, value in self.given.items():
            if not hasattr(self.filters[name], "demand"):
                queryset = self.filters[name].filter(queryset, value)
        return queryset

    @property
    def given(self) -> dict[str, Any]:
        """Filter → value, of what is given and valid."""
        if not self.is_bound:
            return {}
        self.form.is_valid()  # fills cleaned_data with what is valid
        return {
            name: value for name, value in self.form.cleaned_data.items() if value not in (None, "")
        }
