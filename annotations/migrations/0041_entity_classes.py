"""Classes of entities are rows of a world, which begins with those that every world has."""

from dataclasses import asdict

import django.core.validators
import django.db.models.deletion
import simple_history.models
from django.conf import settings
from django.db import migrations, models

from annotations.language.symbols import DEFAULT_CLASSES

BATCH = 1_000


def add_defaults(apps, schema_editor):
    World = apps.get_model("annotations", "World")
    EntityClass = apps.get_model("annotations", "EntityClass")
    rows = (
        EntityClass(world_id=world, position=position, **asdict(value))
        for world in World.objects.values_list("pk", flat=True)
        for position, value in enumerate(DEFAULT_CLASSES)
    )
    EntityClass.objects.bulk_create(rows, batch_size=BATCH)


class Migration(migrations.Migration):

    dependencies = [
        ('annotations', '0040_balance_of_campaigns'),
    ]

    operations = [
        migrations.CreateModel(
            name='HistoricalEntityClass',
            fields=[
                ('id', models.BigIntegerField(auto_created=True, blank=True, db_index=True, verbose_name='ID')),
                ('version', models.PositiveIntegerField(default=1)),
                ('token', models.CharField(max_length=20)),
                ('singular', models.CharField(max_length=60)),
                ('plural', models.CharField(max_length=60)),
                ('said', models.CharField(max_length=60)),
                ('hue', models.PositiveSmallIntegerField(validators=[django.core.validators.MaxValueValidator(359)])),
                ('is_closed', models.BooleanField(default=False)),
                ('position', models.PositiveIntegerField()),
                ('history_id', models.AutoField(primary_key=True, serialize=False)),
                ('history_date', models.DateTimeField(db_index=True)),
                ('history_change_reason', models.CharField(max_length=100, null=True)),
                ('history_type', models.CharField(choices=[('+', 'Created'), ('~', 'Changed'), ('-', 'Deleted')], max_length=1)),
                ('history_user', models.ForeignKey(null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='+', to=settings.AUTH_USER_MODEL)),
                ('world', models.ForeignKey(blank=True, db_constraint=False, null=True, on_delete=django.db.models.deletion.DO_NOTHING, related_name='+', to='annotations.world')),
            ],
            options={
                'verbose_name': 'historical entity class',
                'verbose_name_plural': 'historical entity classes',
                'ordering': ('-history_date', '-history_id'),
                'get_latest_by': ('history_date', 'history_id'),
            },
            bases=(simple_history.models.HistoricalChanges, models.Model),
        ),
        migrations.CreateModel(
            name='EntityClass',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('version', models.PositiveIntegerField(default=1)),
                ('token', models.CharField(max_length=20)),
                ('singular', models.CharField(max_length=60)),
                ('plural', models.CharField(max_length=60)),
                ('said', models.CharField(max_length=60)),
                ('hue', models.PositiveSmallIntegerField(validators=[django.core.validators.MaxValueValidator(359)])),
                ('is_closed', models.BooleanField(default=False)),
                ('position', models.PositiveIntegerField()),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='entity_classes', to='annotations.world')),
            ],
            options={
                'verbose_name_plural': 'entity classes',
                'ordering': ['position'],
                'constraints': [models.UniqueConstraint(fields=('world', 'token'), name='entity_class_token', violation_error_message='There is a class of this token already.'), models.UniqueConstraint(fields=('world', 'position'), name='entity_class_position')],
            },
        ),
        migrations.RunPython(add_defaults, migrations.RunPython.noop),
    ]
