"""A run with answers of every kind, and texts that try to be HTML."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from parser_service.models import Prediction, TrainingRun
from parser_service.reviews.run_report import run_report

EVIL = "<script>alert(1)</script><img src=x onerror=alert(1)>\x0b\x85\ufffe"


@pytest.fixture
def run(sample) -> TrainingRun:
    rows = list(sample.run.predictions.filter(is_exact_match=False).select_related("example"))
    answers = (EVIL, "", '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )')
    for row, answer in zip(rows, answers, strict=False):
        Prediction.objects.filter(pk=row.pk).update(
            logical_form=answer, is_well_formed=answer.startswith("("), label_in_training=2
        )
    type(rows[0].example).objects.filter(pk=rows[0].example_id).update(
        utterance=f"bring {EVIL} “it”", task_category=EVIL
    )
    TrainingRun.objects.filter(pk=sample.run.pk).update(config={"name": EVIL, "depth": 3})
    return TrainingRun.objects.select_related("split", "world").get(pk=sample.run.pk)


@pytest.fixture
def report(run) -> Callable[[], str]:
    return lambda: "".join(run_report(run, "validation"))
