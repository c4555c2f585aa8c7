"""Runs can learn from four sources: ``gen+para+model+said``."""

from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("parser_service", "0017_names_of_error_categories")]

    operations = [
        migrations.AlterField(
            model_name="trainingrun", name="train_sources", field=models.CharField(max_length=24)
        ),
    ]
