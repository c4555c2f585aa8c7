"""What the errors of a run, beside other runs, may be filtered by."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import django_filters
from django import forms
from django.db.models import Exists, OuterRef, QuerySet

from parser_service.models import Prediction, Review, TrainingRun
from parser_service.results.prediction_filters import PredictionFilters
from parser_service.reviews.earlier import new_errors, tagged_before

Rows = QuerySet[Prediction]


class ReviewFilters(PredictionFilters):
    """The first answers of a run. ``runs`` begins with it; the others stand beside it."""

    tagged = django_filters.ChoiceFilter(
        label="Tagged",
        choices=[("me", "by me"), ("somebody", "by somebody"), ("nobody", "by nobody")],
        method="by_tagged",
    )
    earlier = django_filters.ChoiceFilter(
        label="Earlier runs",
        choices=[("tagged", "tagged before"), ("new", "new error")],
        method="by_earlier_runs",
    )
    differ = django_filters.ChoiceFilter(
        label="Runs", choices=[("1", "answers differ")], method="by_difference"
    )
    form = django_filters.CharFilter("logical_form", label="Form", widget=forms.HiddenInput)
    further = (*PredictionFilters.further, "earlier")

    def __init__(self, *args: Any, runs: Sequence[TrainingRun] = (), **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.runs = runs

    @property
    def run(self) -> TrainingRun:
        return self.runs[0]

    def by_tagged(self, rows: Rows, name: str, value: str) -> Rows:
        reviews = Review.objects.filter(run=self.run, example=OuterRef("example"))
        tags = reviews.by_people().filter(category__isnull=False)
        if value == "me":
            tags = tags.filter(reviewer=self.request.user)
        return rows.filter(~Exists(tags) if value == "nobody" else Exists(tags))

    def by_difference(self, rows: Rows, name: str, value: str) -> Rows:
        """Return those to which another run gives another answer."""
        rest = [run.pk for run in self.runs[1:]]
        others = Prediction.objects.best().filter(run__in=rest, example=OuterRef("example"))
        # Right or wrong leaves none out, but has SQLite read the rows in the order of the examples, in which
        # they lie: a third of the time.
        rows = rows.filter(is_exact_match__in=(True, False))
        return rows.filter(Exists(others.exclude(logical_form=OuterRef("logical_form"))))

    def by_earlier_runs(self, rows: Rows, name: str, value: str) -> Rows:
        rows = rows.filter(is_exact_match=False)
        return (new_errors if value == "new" else tagged_before)(rows, self.run)
