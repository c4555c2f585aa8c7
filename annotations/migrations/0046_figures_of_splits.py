"""Splits keep their figures, so that no page counts their examples."""

from django.db import migrations, models


def store(apps, schema_editor):
    from annotations.generation.split_statistics import store_figures

    for split in apps.get_model("annotations", "Split").objects.iterator():
        store_figures(split)


class Migration(migrations.Migration):
    dependencies = [("annotations", "0045_campaigns_of_markets")]

    operations = [
        migrations.AddField(
            model_name="split",
            name="figures",
            field=models.JSONField(blank=True, default=dict, editable=False),
        ),
        migrations.RunPython(store, migrations.RunPython.noop, elidable=True),
    ]
