"""Two runs over one split whose answers differ in every way that a slice can tell apart."""

from __future__ import annotations

import pytest

from parser_service.models import ErrorCategory, Prediction, Review, TrainingRun
from tests.sample_world import SampleWorld, scored_run

# One answer to each of the first validation examples; the rest are right.
ANSWERS = [
    "",
    "( bring <b> (",
    "UNKNOWN",
    '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )',
    '( lambda $1 e ( find ( is_a $1 " <object> " ) ) )',
    '( go " <room> " )',
]


@pytest.fixture
def varied(sample) -> SampleWorld:
    """The sample world, its run with answers of all kinds: no form, no answer, a λ before the head predicate."""
    best = list(sample.run.predictions.order_by("example_id"))
    for number, (row, form) in enumerate(zip(best, ANSWERS, strict=False)):
        row.logical_form = form
        row.is_exact_match = False
        row.is_equivalent = number == 5
        row.is_well_formed = number > 1
        row.is_same_plan = None if number == 2 else number > 3
        row.label_in_training = number
        row.save()
    for row in best[len(ANSWERS) :]:
        Prediction.objects.filter(pk=row.pk).update(
            logical_form=row.example.logical_form,
            is_exact_match=True,
            is_equivalent=True,
            is_same_plan=True,
        )
    wrong = ErrorCategory.objects.create(
        world=sample.world, code="wrong_predicate", name="wrong predicate", position=1
    )
    for number, row in enumerate(best[2:5]):
        Review.objects.create(
            run=sample.run, example=row.example, category=wrong, is_proposed=number > 0
        )
    return sample


@pytest.fixture
def second_run(varied) -> TrainingRun:
    """A run of the same split that has the first eight validation examples right."""
    return scored_run(varied.world, varied.split, right=8, seed=1)
