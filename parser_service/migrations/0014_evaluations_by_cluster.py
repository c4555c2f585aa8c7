"""Evaluations count their outcomes by cluster, and have the interval of a bootstrap of clusters.

Those of older runs are counted from their predictions, which are kept as they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from django.db import migrations, models

from annotations.language.corpus import Criterion, SplitItem
from parser_service.analysis.outcomes import interval_of_outcomes, outcomes_of
from parser_service.analysis.scores import Judgement

AT_ONCE = 5000
SOURCES = {
    "gen": ("generated",),
    "para": ("paraphrased",),
    "mixed": ("generated", "paraphrased"),
}
TEXTS = ("source", "utterance", "source_command", "logical_form")
COLUMNS = (
    "example__part",
    *(f"example__{name}" for name in TEXTS),
    *("is_exact_match", "is_equivalent", "is_well_formed"),
)


class Answer(NamedTuple):
    part: str
    source: str
    cluster: str
    judgement: Judgement


def count(apps: Any, schema_editor: Any) -> None:
    evaluations = apps.get_model("parser_service", "Evaluation").objects.filter(outcomes={})
    runs = apps.get_model("parser_service", "TrainingRun").objects
    for run in runs.filter(pk__in=evaluations.values("run")).select_related("split").order_by("pk"):
        answers = list(_answers(run))
        for evaluation in evaluations.filter(run=run):
            sources = SOURCES[evaluation.test_source]
            mine = [a for a in answers if a.part == evaluation.part and a.source in sources]
            if len(mine) == evaluation.count:
                _fill(evaluation, mine)


def _answers(run: Any) -> Iterator[Answer]:
    by_form = run.split.criterion == "logical_form"
    criterion = Criterion.LOGICAL_FORM if by_form else Criterion.SOURCE_COMMAND
    rows = run.predictions.filter(rank=1).order_by("pk").values_list(*COLUMNS)
    for part, *texts, exact, equivalent, well_formed in rows.iterator(chunk_size=AT_ONCE):
        item = SplitItem(*texts)
        judgement = Judgement(exact, equivalent, well_formed)
        yield Answer(part, item.source, item.key(criterion), judgement)


def _fill(evaluation: Any, answers: list[Answer]) -> None:
    clusters = [answer.cluster for answer in answers]
    evaluation.outcomes = outcomes_of(clusters, [answer.judgement for answer in answers])
    low, high = interval_of_outcomes(evaluation.outcomes) or (0.0, 1.0)
    evaluation.interval_low, evaluation.interval_high = low, high
    evaluation.save(update_fields=["outcomes", "interval_low", "interval_high"])


class Migration(migrations.Migration):
    dependencies = [("parser_service", "0013_answered_by")]

    operations = [
        migrations.AddField(
            model_name="evaluation",
            name="outcomes",
            field=models.JSONField(blank=True, default=dict),
        ),
        migrations.RunPython(count, migrations.RunPython.noop),
    ]
