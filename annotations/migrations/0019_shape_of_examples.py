"""Examples know their head predicate, the depth of their form and their number of words."""

from __future__ import annotations

from django.db import migrations, models

from annotations.models.splits import shape_of

BATCH = 1000


def fill(apps, schema_editor):
    """Fill the columns of the rows that are there, in batches."""
    Example = apps.get_model("annotations", "Example")
    objects = Example.objects.using(schema_editor.connection.alias)
    rows = objects.order_by("pk").only("pk", "logical_form", "utterance")
    last = 0
    while some := list(rows.filter(pk__gt=last)[:BATCH]):
        for row in some:
            row.head_predicate, row.depth = shape_of(row.logical_form)
            row.word_count = len(row.utterance.split())
        objects.bulk_update(some, ["head_predicate", "depth", "word_count"], batch_size=100)
        last = some[-1].pk


class Migration(migrations.Migration):
    dependencies = [("annotations", "0018_command_proposals")]

    operations = [
        migrations.AddField(
            model_name="example",
            name="head_predicate",
            field=models.CharField(blank=True, default="", editable=False, max_length=80),
        ),
        migrations.AddField(
            model_name="example",
            name="depth",
            field=models.PositiveIntegerField(default=0, editable=False),
        ),
        migrations.AddField(
            model_name="example",
            name="word_count",
            field=models.PositiveIntegerField(default=0, editable=False),
        ),
        migrations.RunPython(fill, migrations.RunPython.noop),
    ]
