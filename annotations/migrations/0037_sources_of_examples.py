"""What a language model wrote is a source of its own; a split can ask for it in validation and test.

A frozen split keeps what it holds: its examples of models become the new source, and its hash is made anew, since the
source is hashed. ``said``, for labelled utterances, comes with splits that are frozen from now on.
"""

from django.db import migrations, models

from annotations.language.corpus import FrozenExample, content_hash


def name_models(apps, schema_editor):
    example = apps.get_model("annotations", "Example")
    keys = list(
        example.objects.filter(is_by_model=True).order_by().values_list("split", flat=True).distinct()
    )
    example.objects.filter(is_by_model=True).update(source="model")
    for split in apps.get_model("annotations", "Split").objects.filter(pk__in=keys):
        rows = example.objects.filter(split=split).order_by("source", "part", "position")
        texts = rows.values_list(
            *("part", "source", "utterance", "source_command", "task_category"),
            *("logical_form", "grounded_form"),
        )
        split.content_hash = content_hash(FrozenExample(*each) for each in texts.iterator(5000))
        split.save(update_fields=["content_hash"])


def name_paraphrases(apps, schema_editor):
    """Call everything paraphrased that was not generated, and mark what models wrote.

    Positions of a part are counted on, so that each is there once.
    """
    example = apps.get_model("annotations", "Example")
    for row in example.objects.filter(source__in=("model", "said")).order_by("pk"):
        alike = example.objects.filter(split=row.split, part=row.part, source="paraphrased")
        last = alike.order_by("-position").values_list("position", flat=True).first()
        row.is_by_model = row.source == "model"
        row.source, row.position = "paraphrased", 0 if last is None else last + 1
        row.save(update_fields=["source", "is_by_model", "position"])


class Migration(migrations.Migration):
    dependencies = [("annotations", "0036_examples_by_models")]

    operations = [
        migrations.AddField(
            model_name="split",
            name="tests_on_models",
            field=models.BooleanField(db_default=False, default=False),
        ),
        migrations.RunPython(name_models, name_paraphrases),
        migrations.RemoveField(model_name="example", name="is_by_model"),
    ]
