"""What people said of the errors of earlier runs: reviews survive retraining.

An error of a run was tagged before where somebody has tagged an answer of an earlier run of the same world
to the same utterance with the same label, in whatever split it stands.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from django.db.models import Exists, OuterRef, QuerySet

from annotations.models import Example
from parser_service.models import Prediction, Review, TrainingRun
from parser_service.models.reviews import ReviewQuerySet


def tags_before(run: TrainingRun) -> ReviewQuerySet:
    """Return the tags that people have given to answers of runs of the same world before ``run``."""
    earlier = TrainingRun.objects.filter(world=run.world_id, pk__lt=run.pk)
    return Review.objects.by_people().filter(run__in=earlier, category__isnull=False)


def tags_of_example_before(run: TrainingRun, example: Example) -> Sequence[Review]:
    """Return those of the utterance and label of ``example``, the newest first."""
    rows = tags_before(run).filter(
        example__utterance=example.utterance, example__logical_form=example.logical_form
    )
    return list(rows.select_related("category", "reviewer", "run").order_by("-changed_at", "-pk"))


def tagged_before(rows: QuerySet[Prediction], run: TrainingRun) -> QuerySet[Prediction]:
    """Return those of ``rows``, predictions of ``run``, whose example was tagged in an earlier run."""
    tags = tags_before(run).order_by()
    pairs = set(tags.values_list("example__utterance", "example__logical_form"))
    if not pairs:
        return rows.none()
    same_text = Example.objects.filter(
        split=run.split_id, utterance__in=tags.values("example__utterance")
    )
    rows_of_text = same_text.order_by().values_list("pk", "utterance", "logical_form")
    return rows.filter(example__in=[key for key, *pair in rows_of_text if tuple(pair) in pairs])


def new_errors(rows: QuerySet[Prediction], run: TrainingRun) -> QuerySet[Prediction]:
    """Return those of ``rows`` that no earlier run of the same parser had wrong, as the proposals say."""
    new = run.reviews.proposed().filter(is_new=True, example=OuterRef("example"))
    return rows.filter(Exists(new))


@dataclass(frozen=True, slots=True)
class ErrorHistory:
    """How many errors of a run were tagged before, and how many are new (None: no earlier run)."""

    errors: int
    tagged_before: int
    new: int | None


def history_of_errors(run: TrainingRun) -> ErrorHistory:
    """Count what is known of the errors of ``run`` from earlier runs."""
    errors = run.predictions.best().filter(is_exact_match=False)
    proposals = run.reviews.proposed()
    is_compared = proposals.filter(is_new__isnull=False).exists()
    return ErrorHistory(
        errors=errors.count(),
        tagged_before=tagged_before(errors, run).count(),
        new=proposals.filter(is_new=True).count() if is_compared else None,
    )
