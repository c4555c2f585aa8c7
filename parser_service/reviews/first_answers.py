"""The first answers of a run, and the errors of those before it, as plain values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from parser_service.models import Prediction, TrainingRun

ROWS_AT_ONCE = 2_000


@dataclass(frozen=True, slots=True)
class FirstAnswer:
    """The first answer of a run to the example with the key ``example``. Forms are text."""

    example: int
    utterance: str
    label: str
    answer: str
    is_right: bool


def read_answers(run: TrainingRun, check: Callable[[], None]) -> list[FirstAnswer]:
    """Return the first answers of ``run`` in the order of their examples.

    ``check`` is called between rows and may raise to stop the reading.
    """
    columns = ("example_id", "example__utterance", "example__logical_form", "logical_form")
    rows = run.predictions.best().order_by("example_id").values_list(*columns, "is_exact_match")
    texts: dict[str, str] = {}  # a million rows share few forms
    answers = []
    for key, utterance, label, answer, is_right in rows.iterator(chunk_size=ROWS_AT_ONCE):
        check()
        label, answer = texts.setdefault(label, label), texts.setdefault(answer, answer)
        answers.append(FirstAnswer(key, utterance, label, answer, is_right))
    return answers


def read_earlier_errors(run: TrainingRun) -> frozenset[tuple[str, str]] | None:
    """Return utterance and label of all that earlier runs of the same parser answered wrongly, whatever
    their split; None where there is no earlier run with answers."""
    earlier = Prediction.objects.best().filter(
        run__world=run.world_id, run__parser=run.parser, run__lt=run.pk
    )
    if not earlier.exists():
        return None
    wrong = earlier.filter(is_exact_match=False).order_by()
    pairs = wrong.values_list("example__utterance", "example__logical_form").distinct()
    return frozenset(pairs.iterator(chunk_size=ROWS_AT_ONCE))
