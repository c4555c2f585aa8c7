"""What the report of a run shows, a section each: reviews by category, what a worker found out, wrong answers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from django.db.models import Count, QuerySet
from django.utils.safestring import SafeString

from annotations.showing.form_presentation import Pieces, difference
from parser_service.analysis.sensitivity import ALL_KINDS
from parser_service.models import ErrorCategory, Prediction, Review, TrainingRun
from parser_service.parsers.conditions import in_words
from parser_service.reviews.charts import Line, draw_lines
from parser_service.reviews.probe_kinds import PROBE_KINDS

MOST_EXAMPLES = 3  # of a category
MOST_ATTRACTORS = 15
MOST_WRONG = 2_000
ROWS_AT_ONCE = 200


@dataclass(frozen=True, slots=True)
class CategoryReviews:
    """``proposed`` by the machine, ``given`` by people."""

    category: ErrorCategory
    proposed: int
    given: int


def count_reviews(run: TrainingRun, part: str) -> list[CategoryReviews]:
    """Count the reviews of the answers to ``part``, for each category that has any."""
    reviews = run.reviews.filter(example__part=part, category__isnull=False).order_by()
    counted = reviews.values_list("category", "is_proposed").annotate(Count("pk"))
    counts = {(key, is_proposed): count for key, is_proposed, count in counted}
    return [
        CategoryReviews(
            category, counts.get((category.pk, True), 0), counts.get((category.pk, False), 0)
        )
        for category in run.world.error_categories.all()
        if {(category.pk, True), (category.pk, False)} & counts.keys()
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
        yield (
            category,
            [
                ReviewedAnswer(review, *difference(review.example.logical_form, review.answer))
                for review in chosen
            ],
        )


def attractor_tables(
    findings: Mapping[str, Sequence[Mapping[str, Any]]],
) -> Iterator[tuple[str, Sequence[Mapping[str, Any]], int]]:
    """Yield source in words, its first rows, and how many there are."""
    for source, rows in findings.items():
        yield in_words(source), rows[:MOST_ATTRACTORS], len(rows)


def refusal_curves(findings: Mapping[str, Mapping[str, Any]]) -> SafeString:
    """Draw the share of wrong answers by the share of utterances that are answered, a line a source."""
    lines = [
        Line(
            source,
            [100 * answered / curve["count"] for answered in curve["answered"]],
            [
                100 * wrong / answered if answered else None
                for wrong, answered in zip(curve["wrong"], curve["answered"], strict=True)
            ],
        )
        for source, curve in findings.items()
    ]
    return draw_lines(
        "Share of wrong answers by the share of utterances that are answered",
        lines,
        "answered, % of the utterances",
        "wrong, % of the answers",
        x_most=100.0,
    )


def edit_rows(
    findings: Sequence[Mapping[str, Any]],
) -> list[tuple[str, Mapping[str, Any]]]:
    """Return each kind of edit in words, with its row; all of them together come last."""
    names = {**{str(kind): name for kind, name in PROBE_KINDS.items()}, ALL_KINDS: "all edits"}
    return [(names.get(row["kind"], row["kind"]), row) for row in findings]


@dataclass(frozen=True, slots=True)
class WrongPrediction:
    """A first answer that is wrong; ``expected`` and ``predicted`` are both forms in pieces, what changes marked."""

    prediction: Prediction
    expected: Pieces
    predicted: Pieces


def count_wrong(run: TrainingRun, part: str) -> int:
    return _wrong(run, part).count()


def wrong_answers(run: TrainingRun, part: str, most: int = MOST_WRONG) -> Iterator[WrongPrediction]:
    """Yield the first wrong answers, at most ``most``, in the order of their examples."""
    rows = _wrong(run, part).order_by("example_id").select_related("example")
    compare = lru_cache(maxsize=4096)(difference)
    for row in rows[:most].iterator(chunk_size=ROWS_AT_ONCE):
        yield WrongPrediction(row, *compare(row.example.logical_form, row.logical_form))


def _wrong(run: TrainingRun, part: str) -> QuerySet[Prediction]:
    return run.predictions.best().filter(example__part=part, is_exact_match=False)
