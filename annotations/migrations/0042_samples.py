"""Worlds and splits remember that their commands are a sample."""

from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("annotations", "0040_balance_of_campaigns")]

    operations = [
        migrations.AddField(
            model_name=name,
            name="sample",
            field=models.JSONField(blank=True, default=dict, editable=False),
        )
        for name in ("world", "split")
    ]
