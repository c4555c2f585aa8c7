"""How often the answers of a run have been put into each error category, and examples of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from django.db.models import Count

from annotations.presentation import Pieces, difference
from parser_service.models import ErrorCategory, Review, TrainingRun

MOST_EXAMPLES = 3  # of a category


@dataclass(frozen=True, slots=True)
class CategoryCount:
    """``proposed`` by the machine, ``given`` by people."""

    category: ErrorCategory
    proposed: int
    given: int


def count_reviews(run: TrainingRun, part: str) -> list[CategoryCount]:
    """Count the reviews of the answers to ``part``, for each category that has any."""
    reviews = run.reviews.filter(example__part=part, category__isnull=False).order_by()
    counted = reviews.values_list("category", "is_proposed").annotate(Count("pk"))
    counts = {(key, is_proposed): count for key, is_proposed, count in counted}
    return [
        CategoryCount(each, counts.get((each.pk, True), 0), counts.get((each.pk, False), 0))
        for each in run.world.error_categories.all()
        if {(each.pk, True), (each.pk, False)} & counts.keys()
    ]


@dataclass(frozen=True, slots=True)
class ReviewedAnswer:
    """An answer with what was said of it; ``expected`` and ``predicted`` are its forms in pieces."""

    review: Review
    expected: Pieces
    predicted: Pieces


def examples_by_category(
    run: TrainingRun, part: str, categories: Sequence[ErrorCategory]
) -> Iterator[tuple[ErrorCategory, list[ReviewedAnswer]]]:
    """Yield each category with a few answers of ``part``, those that people have put into it first."""
    reviews = run.reviews.filter(example__part=part).select_related("example", "reviewer")
    for category in categories:
        of_category = reviews.filter(category=category)
        chosen = list(of_category.filter(is_proposed=False).order_by("pk")[:MOST_EXAMPLES])
        known = {each.example_id for each in chosen}
        proposed = of_category.filter(is_proposed=True).exclude(example__in=known)
        chosen += proposed.order_by("pk")[: MOST_EXAMPLES - len(chosen)]
        yield category, [_reviewed(each) for each in chosen]


def _reviewed(review: Review) -> ReviewedAnswer:
    return ReviewedAnswer(review, *difference(review.example.logical_form, review.answer))
