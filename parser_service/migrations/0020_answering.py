"""What a world answers with, and how good its answers are."""

import annotations.models.splits
import django.core.validators
import django.db.models.deletion
import django.utils.timezone
import parser_service.models.answering
from django.conf import settings
from django.db import migrations, models


class Migration(migrations.Migration):

    dependencies = [
        ('annotations', '0001_squashed_0044'),
        ('parser_service', '0001_squashed_0019'),
        migrations.swappable_dependency(settings.AUTH_USER_MODEL),
    ]

    operations = [
        migrations.CreateModel(
            name='Answering',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('order', models.CharField(choices=parser_service.models.answering.answering_order_choices, default='both', max_length=8)),
                ('allowed_wrong', models.FloatField(default=0.02, validators=[django.core.validators.MinValueValidator(0.0), django.core.validators.MaxValueValidator(0.5)])),
                ('version', models.PositiveIntegerField(default=1)),
                ('changed_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('changed_by', models.ForeignKey(null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='+', to=settings.AUTH_USER_MODEL)),
                ('world', models.OneToOneField(on_delete=django.db.models.deletion.CASCADE, related_name='answering', to='annotations.world')),
            ],
            options={
                'verbose_name_plural': 'answering',
            },
        ),
        migrations.CreateModel(
            name='AnswererEvaluation',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('order', models.CharField(choices=parser_service.models.answering.answering_order_choices, max_length=8)),
                ('part', models.CharField(choices=annotations.models.splits.part_choices, max_length=12)),
                ('test_source', models.CharField(max_length=8)),
                ('count', models.PositiveIntegerField()),
                ('correct', models.PositiveIntegerField()),
                ('same_plan', models.PositiveIntegerField()),
                ('acted', models.PositiveIntegerField()),
                ('wrong_acts', models.PositiveIntegerField()),
                ('confirmed', models.PositiveIntegerField()),
                ('confirmed_right', models.PositiveIntegerField()),
                ('asked', models.PositiveIntegerField()),
                ('refused', models.PositiveIntegerField()),
                ('intervals', models.JSONField(default=dict)),
                ('brier', models.FloatField(null=True)),
                ('brier_before', models.FloatField(null=True)),
                ('calibration', models.JSONField(default=dict)),
                ('answers', models.JSONField(default=list)),
                ('revision', models.PositiveIntegerField()),
                ('seconds', models.FloatField()),
                ('made_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('run', models.ForeignKey(null=True, on_delete=django.db.models.deletion.CASCADE, related_name='answerer_evaluations', to='parser_service.trainingrun')),
                ('split', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='answerer_evaluations', to='annotations.split')),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='answerer_evaluations', to='annotations.world')),
            ],
            options={
                'ordering': ['-made_at', 'part', 'test_source'],
                'indexes': [models.Index(fields=['world', 'split', '-made_at'], name='parser_serv_world_i_60f0b4_idx')],
            },
        ),
    ]
