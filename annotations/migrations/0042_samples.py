"""Worlds and splits remember that their commands are a sample."""

from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("annotations", "0041_entity_classes")]

    operations = [
        migrations.AddField(
            model_name=name,
            name="sample",
            field=models.JSONField(blank=True, default=dict, editable=False),
        )
        for name in ("world", "split")
    ]
