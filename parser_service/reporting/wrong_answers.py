"""The wrong answers of a run with the differences to their labels, as a stream."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from django.db.models import QuerySet

from annotations.presentation import Pieces, difference
from parser_service.models import Prediction, TrainingRun

MOST_WRONG = 2_000
ROWS_AT_ONCE = 200


@dataclass(frozen=True, slots=True)
class WrongAnswer:
    """A first answer that is wrong; ``expected`` and ``predicted`` are both forms in pieces, what changes marked."""

    prediction: Prediction
    expected: Pieces
    predicted: Pieces


def count_wrong(run: TrainingRun, part: str) -> int:
    return _wrong(run, part).count()


def wrong_answers(run: TrainingRun, part: str, most: int = MOST_WRONG) -> Iterator[WrongAnswer]:
    """Yield the first wrong answers, at most ``most``, in the order of their examples."""
    rows = _wrong(run, part).order_by("example_id").select_related("example")
    compare = lru_cache(maxsize=4096)(difference)
    for row in rows[:most].iterator(chunk_size=ROWS_AT_ONCE):
        yield WrongAnswer(row, *compare(row.example.logical_form, row.logical_form))


def _wrong(run: TrainingRun, part: str) -> QuerySet[Prediction]:
    return run.predictions.best().filter(example__part=part, is_exact_match=False)
