"""Answers with the plan of the annotated form are counted. Of earlier answers it is not known: null."""

from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("parser_service", "0018_more_train_sources")]

    operations = [
        migrations.AddField(
            model_name="prediction",
            name="is_same_plan",
            field=models.BooleanField(blank=True, null=True),
        ),
        migrations.AddField(
            model_name="evaluation",
            name="same_plan",
            field=models.FloatField(blank=True, null=True),
        ),
    ]
