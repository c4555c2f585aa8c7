"""Campaigns say who runs them and which crowd market they are for; texts say in which browser they were written.

Accounts have a manager of their own.
"""

from django.db import migrations, models

# Name → characters.
TEXTS = {
    "assignment_parameter": 40,
    "contact": 200,
    "frame_origins": 500,
    "run_by": 200,
    "screened_out_code": 40,
    "screening_question": 300,
    "worker_parameter": 40,
}


class Migration(migrations.Migration):
    dependencies = [("annotations", "0001_squashed_0044")]

    operations = [
        migrations.AlterModelManagers(name="user", managers=[]),
        *(
            migrations.AddField(
                model_name="campaign",
                name=name,
                field=models.CharField(blank=True, db_default="", default="", max_length=characters),
            )
            for name, characters in TEXTS.items()
        ),
        migrations.AddField(
            model_name="campaign",
            name="minutes",
            field=models.PositiveSmallIntegerField(blank=True, null=True),
        ),
        migrations.AddField(
            model_name="campaign",
            name="screened_out_url",
            field=models.URLField(blank=True, db_default="", default="", max_length=500),
        ),
        migrations.AddField(
            model_name="submission",
            name="browser",
            field=models.CharField(blank=True, db_default="", default="", max_length=32),
        ),
    ]
