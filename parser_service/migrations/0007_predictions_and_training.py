"""Fill what can be known of older runs: how often training had each form, and what their scores are.

Splits are frozen, so their training examples are still those that the runs learned from.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

from django.db import migrations

AT_ONCE = 5000
SOURCES = {
    "gen": ("generated",),
    "para": ("paraphrased",),
    "gen+para": ("generated", "paraphrased"),
}
LOG_PROBABILITY, SIMILARITY = "log_probability", "similarity"
ALWAYS_FROM_GRAMMAR = "grammar-oracle"
FROM_PAIRS_ALONE = "knn"  # what is not from a training pair is from a validation pair


def fill(apps: Any, schema_editor: Any) -> None:
    runs, predictions = (
        apps.get_model("parser_service", name).objects for name in ("TrainingRun", "Prediction")
    )
    scored = runs.filter(status="succeeded", score_kind="").order_by()
    for parser in scored.values_list("parser", flat=True).distinct():
        scored.filter(parser=parser).update(score_kind=_score_kind(parser))
    table = schema_editor.quote_name(predictions.model._meta.db_table)
    update = (
        f"UPDATE {table} SET answer_in_training = %s, label_in_training = %s, origin = %s "
        "WHERE id = %s"
    )
    examples = apps.get_model("annotations", "Example").objects
    learned_by = _learned_by(runs, examples)
    with schema_editor.connection.cursor() as cursor:
        for batch in _batches(predictions):
            rows = [
                (*_facts(*learned_by(run), form, label), key) for key, run, form, label in batch
            ]
            cursor.executemany(update, rows)
    # These hold copies of the counts, and are made again when somebody looks.
    apps.get_model("parser_service", "AnswerColumns").objects.all().delete()


def _learned_by(runs: Any, examples: Any) -> Callable[[int], tuple[str, Counter[str]]]:
    """Return a function from the key of a run to its parser and how many of its training pairs have a
    form; runs with the same training pairs share the counts."""
    columns = runs.values_list("pk", "parser", "split_id", "train_sources")
    about = {key: (parser, split, sources) for key, parser, split, sources in columns}

    @cache
    def count(split: int, sources: str) -> Counter[str]:
        learned = examples.filter(split=split, part="train", source__in=SOURCES[sources])
        return Counter(learned.order_by().values_list("logical_form", flat=True).iterator())

    def learned_by(run: int) -> tuple[str, Counter[str]]:
        parser, split, sources = about[run]
        return parser, count(split, sources)

    return learned_by


def _batches(predictions: Any) -> Iterator[list[tuple[int, int, str, str]]]:
    """Yield key, run, form and label of all predictions that are not filled, by key."""
    unfilled = predictions.filter(label_in_training__isnull=True).order_by("pk")
    columns = ("pk", "run_id", "logical_form", "example__logical_form")
    last = 0
    while batch := list(unfilled.filter(pk__gt=last).values_list(*columns)[:AT_ONCE]):
        yield batch
        last = batch[-1][0]


def _facts(
    parser: str, counts: Counter[str], form: str, label: str
) -> tuple[int | None, int, str]:
    """Return both counts and the origin of a prediction."""
    seen = counts[form] if form else None
    return seen, counts[label], _origin(parser, form, seen)


def _score_kind(parser: str) -> str:
    if parser == "ranker" or parser.startswith("seq2seq"):
        return LOG_PROBABILITY
    return SIMILARITY if parser == FROM_PAIRS_ALONE else ""


def _origin(parser: str, form: str, seen: int | None) -> str:
    if not form:
        return ""
    if parser == ALWAYS_FROM_GRAMMAR:
        return "grammar"
    if seen:
        return "training"
    return "validation" if parser == FROM_PAIRS_ALONE else ""


class Migration(migrations.Migration):
    dependencies = [("parser_service", "0006_columns")]

    operations = [migrations.RunPython(fill, migrations.RunPython.noop)]
