from django.db import migrations, models


def keep_track_of_existing_runs(apps, schema_editor):
    runs = apps.get_model("parser_service", "TrainingRun").objects.values_list("pk", flat=True)
    folder = apps.get_model("parser_service", "RunFolder")
    folder.objects.bulk_create([folder(run_number=number) for number in runs], batch_size=500)


class Migration(migrations.Migration):

    dependencies = [
        ("parser_service", "0002_run_resumes"),
    ]

    operations = [
        migrations.CreateModel(
            name="RunFolder",
            fields=[
                ("id", models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name="ID")),
                ("run_number", models.PositiveBigIntegerField(unique=True)),
                ("orphaned_at", models.DateTimeField(blank=True, null=True)),
            ],
            options={
                "ordering": ["run_number"],
            },
        ),
        migrations.RunPython(keep_track_of_existing_runs, migrations.RunPython.noop),
    ]
