"""Runs may learn from a share of the training pairs, and say from how many they learned."""

from __future__ import annotations

from functools import cache
from typing import Any

from django.db import migrations, models

SOURCES = {
    "gen": ("generated",),
    "para": ("paraphrased",),
    "gen+para": ("generated", "paraphrased"),
}


def count_pairs(apps: Any, schema_editor: Any) -> None:
    """Older runs learned from all training pairs of their sources."""
    runs = apps.get_model("parser_service", "TrainingRun").objects
    examples = apps.get_model("annotations", "Example").objects
    scored = runs.filter(status="succeeded", train_pairs=None).order_by()
    kinds = scored.values_list("split_id", "train_sources").distinct()

    @cache
    def count(split: int, source: str) -> int:
        return examples.filter(split=split, part="train", source=source).count()

    for split, sources in list(kinds):
        pairs = sum(count(split, source) for source in SOURCES[sources])
        scored.filter(split=split, train_sources=sources).update(train_pairs=pairs)


class Migration(migrations.Migration):
    dependencies = [("parser_service", "0008_tryout")]

    operations = [
        migrations.AddField("trainingrun", "train_share", models.FloatField(default=1.0)),
        migrations.AddField(
            "trainingrun", "train_pairs", models.PositiveIntegerField(blank=True, null=True)
        ),
        migrations.RunPython(count_pairs, migrations.RunPython.noop),
    ]
