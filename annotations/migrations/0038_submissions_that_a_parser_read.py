"""Submissions note which run was asked what they mean."""

from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("annotations", "0037_sources_of_examples")]

    operations = [
        migrations.AddField(
            model_name="submission",
            name="read_by_run",
            field=models.PositiveBigIntegerField(blank=True, null=True),
        ),
    ]
