import django.db.models.deletion
from django.db import migrations, models

import annotations.models.splits


class Migration(migrations.Migration):
    dependencies = [
        ("annotations", "0019_shape_of_examples"),
        ("parser_service", "0005_new_errors"),
    ]

    operations = [
        migrations.CreateModel(
            name="ExampleColumns",
            fields=[
                (
                    "id",
                    models.BigAutoField(
                        auto_created=True, primary_key=True, serialize=False, verbose_name="ID"
                    ),
                ),
                (
                    "part",
                    models.CharField(choices=annotations.models.splits.part_choices, max_length=12),
                ),
                ("data", models.BinaryField()),
                (
                    "split",
                    models.ForeignKey(
                        on_delete=django.db.models.deletion.CASCADE,
                        related_name="columns",
                        to="annotations.split",
                    ),
                ),
            ],
            options={
                "ordering": ["split", "part"],
                "constraints": [
                    models.UniqueConstraint(fields=("split", "part"), name="example_columns_once")
                ],
            },
        ),
        migrations.CreateModel(
            name="AnswerColumns",
            fields=[
                (
                    "id",
                    models.BigAutoField(
                        auto_created=True, primary_key=True, serialize=False, verbose_name="ID"
                    ),
                ),
                (
                    "part",
                    models.CharField(choices=annotations.models.splits.part_choices, max_length=12),
                ),
                ("data", models.BinaryField()),
                (
                    "run",
                    models.ForeignKey(
                        on_delete=django.db.models.deletion.CASCADE,
                        related_name="columns",
                        to="parser_service.trainingrun",
                    ),
                ),
            ],
            options={
                "ordering": ["run", "part"],
                "constraints": [
                    models.UniqueConstraint(fields=("run", "part"), name="answer_columns_once")
                ],
            },
        ),
    ]
