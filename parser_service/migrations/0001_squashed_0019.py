"""The tables of commit 7eb91d0, whose migrations this one replaces."""

import annotations.models.background
import annotations.models.splits
import django.db.models.deletion
import django.db.models.functions.text
import django.utils.timezone
import parser_service.models.analyses
import parser_service.models.dialogues
import parser_service.models.promotions
import parser_service.models.runs
from django.conf import settings
from django.db import migrations, models

from annotations.migrations._create_models import CreateModels


class Migration(migrations.Migration):

    replaces = [
        ("parser_service", name)
        for name in (
            "0001_initial",
            "0002_run_resumes",
            "0003_runfolder",
            "0004_error_analysis",
            "0005_new_errors",
            "0006_columns",
            "0007_predictions_and_training",
            "0008_tryout",
            "0009_train_share",
            "0010_promotion",
            "0011_dialogues_and_action_names",
            "0012_answers_by_length",
            "0013_answered_by",
            "0014_evaluations_by_cluster",
            "0015_predictions_say_what_was_cut",
            "0016_sqlite_holds_limits",
            "0017_names_of_error_categories",
            "0018_more_train_sources",
            "0019_same_plan",
        )
    ]

    initial = True

    dependencies = [
        ('annotations', '0001_squashed_0044'),
    ]

    operations = [CreateModels([
        migrations.CreateModel(
            name='Worker',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('name', models.CharField(max_length=200, unique=True)),
                ('host', models.CharField(max_length=200)),
                ('process_id', models.PositiveIntegerField()),
                ('queue', models.CharField(max_length=20)),
                ('started_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('last_seen', models.DateTimeField(default=django.utils.timezone.now)),
            ],
            options={
                'ordering': ['name'],
            },
        ),
        migrations.CreateModel(
            name='TrainingRun',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('parser', models.CharField(max_length=60)),
                ('parser_version', models.PositiveIntegerField()),
                ('config', models.JSONField(default=dict)),
                ('protocol', models.CharField(choices=parser_service.models.runs.protocol_choices, max_length=12)),
                ('train_sources', models.CharField(max_length=24)),
                ('seed', models.PositiveBigIntegerField(default=0)),
                ('queue', models.CharField(choices=annotations.models.background.queue_choices, default='cpu', max_length=8)),
                ('content_key', models.CharField(max_length=64)),
                ('status', models.CharField(choices=annotations.models.background.status_choices, default='queued', max_length=12)),
                ('attempt', models.PositiveIntegerField(default=0)),
                ('lease_until', models.DateTimeField(blank=True, null=True)),
                ('worker', models.CharField(blank=True, max_length=200)),
                ('cancel_requested', models.BooleanField(default=False)),
                ('progress', models.FloatField(default=0)),
                ('activity', models.CharField(blank=True, max_length=200)),
                ('failure', models.TextField(blank=True)),
                ('parameters', models.PositiveBigIntegerField(blank=True, null=True)),
                ('seconds_trained', models.FloatField(default=0)),
                ('queued_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('started_at', models.DateTimeField(blank=True, null=True)),
                ('finished_at', models.DateTimeField(blank=True, null=True)),
                ('created_by', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.SET_NULL, to=settings.AUTH_USER_MODEL)),
                ('split', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='runs', to='annotations.split')),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='runs', to='annotations.world')),
                ('resumes', models.PositiveSmallIntegerField(default=0)),
                ('score_kind', models.CharField(blank=True, choices=parser_service.models.runs.score_kind_choices, max_length=20)),
                ('train_share', models.FloatField(default=1.0)),
                ('train_pairs', models.PositiveIntegerField(blank=True, null=True)),
                ('answered_by', models.CharField(blank=True, max_length=200)),
            ],
            options={
                'ordering': ['-id'],
                'indexes': [models.Index(fields=['status', 'queue', 'queued_at'], name='parser_serv_status_415303_idx'), models.Index(fields=['world', '-id'], name='parser_serv_world_i_f358ea_idx')],
                'constraints': [models.UniqueConstraint(condition=models.Q(('status__in', ['queued', 'running', 'succeeded'])), fields=('world', 'content_key'), name='trained_once')],
            },
        ),
        migrations.CreateModel(
            name='RunEvent',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('attempt', models.PositiveIntegerField()),
                ('at', models.DateTimeField(default=django.utils.timezone.now)),
                ('message', models.TextField()),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='events', to='parser_service.trainingrun')),
            ],
            options={
                'ordering': ['id'],
            },
        ),
        migrations.CreateModel(
            name='Prediction',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('rank', models.PositiveSmallIntegerField()),
                ('logical_form', models.TextField(blank=True)),
                ('score', models.FloatField()),
                ('is_exact_match', models.BooleanField()),
                ('is_equivalent', models.BooleanField()),
                ('is_well_formed', models.BooleanField()),
                ('example', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='predictions', to='annotations.example')),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='predictions', to='parser_service.trainingrun')),
                ('answer_in_training', models.PositiveIntegerField(blank=True, null=True)),
                ('label_in_training', models.PositiveIntegerField(blank=True, null=True)),
                ('origin', models.CharField(blank=True, max_length=20)),
                ('score_parts', models.JSONField(blank=True, default=dict)),
                ('is_cut', models.BooleanField(db_default=False, default=False)),
                ('is_same_plan', models.BooleanField(blank=True, null=True)),
            ],
            options={
                'ordering': ['run', 'example', 'rank'],
                'indexes': [models.Index(fields=['run', 'rank', 'is_exact_match', 'example'], name='answers_in_order'), models.Index(models.F('run'), models.F('rank'), django.db.models.functions.text.Length('logical_form'), models.F('is_exact_match'), models.F('example'), name='answers_by_length')],
                'constraints': [models.UniqueConstraint(fields=('run', 'example', 'rank'), name='predicted_once')],
            },
        ),
        migrations.CreateModel(
            name='Evaluation',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('test_source', models.CharField(max_length=8)),
                ('part', models.CharField(max_length=12)),
                ('count', models.PositiveIntegerField()),
                ('correct', models.PositiveIntegerField()),
                ('accuracy', models.FloatField()),
                ('interval_low', models.FloatField()),
                ('interval_high', models.FloatField()),
                ('equivalent', models.FloatField()),
                ('well_formed', models.FloatField()),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='evaluations', to='parser_service.trainingrun')),
                ('outcomes', models.JSONField(blank=True, default=dict)),
                ('same_plan', models.FloatField(blank=True, null=True)),
            ],
            options={
                'ordering': ['run', 'part', 'test_source'],
                'constraints': [models.UniqueConstraint(fields=('run', 'test_source', 'part'), name='evaluated_once')],
            },
        ),
        migrations.CreateModel(
            name='EpochMetric',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('epoch', models.PositiveIntegerField()),
                ('train_loss', models.FloatField()),
                ('validation_loss', models.FloatField(null=True)),
                ('validation_accuracy', models.FloatField(null=True)),
                ('seconds', models.FloatField()),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='epochs', to='parser_service.trainingrun')),
            ],
            options={
                'ordering': ['epoch'],
                'constraints': [models.UniqueConstraint(fields=('run', 'epoch'), name='epoch_once')],
            },
        ),
        migrations.CreateModel(
            name='Checkpoint',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('epoch', models.PositiveIntegerField()),
                ('folder', models.CharField(max_length=300)),
                ('sha256', models.CharField(max_length=64)),
                ('is_best', models.BooleanField(default=False)),
                ('created_at', models.DateTimeField(auto_now_add=True)),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='checkpoints', to='parser_service.trainingrun')),
            ],
            options={
                'ordering': ['epoch'],
            },
        ),
        migrations.CreateModel(
            name='RunFolder',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('run_number', models.PositiveBigIntegerField(unique=True)),
                ('orphaned_at', models.DateTimeField(blank=True, null=True)),
            ],
            options={
                'ordering': ['run_number'],
            },
        ),
        migrations.CreateModel(
            name='Probe',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('position', models.PositiveIntegerField()),
                ('kind', models.CharField(max_length=20)),
                ('utterance', models.TextField(blank=True)),
                ('old', models.CharField(blank=True, max_length=300)),
                ('new', models.CharField(blank=True, max_length=300)),
                ('expectation', models.CharField(choices=parser_service.models.analyses.expectation_choices, max_length=8)),
                ('expected_form', models.TextField(blank=True)),
                ('base', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.CASCADE, related_name='probes', to='annotations.example')),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='probes', to='parser_service.trainingrun')),
            ],
            options={
                'ordering': ['position'],
                'indexes': [models.Index(fields=['run', 'kind'], name='parser_serv_run_id_a5a60d_idx')],
                'constraints': [models.UniqueConstraint(fields=('run', 'position'), name='probe_position')],
            },
        ),
        migrations.CreateModel(
            name='ProbeAnswer',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('logical_form', models.TextField(blank=True)),
                ('score', models.FloatField()),
                ('is_expected', models.BooleanField(null=True)),
                ('probe', models.OneToOneField(on_delete=django.db.models.deletion.CASCADE, related_name='answer', to='parser_service.probe')),
            ],
            options={
                'ordering': ['probe'],
            },
        ),
        migrations.CreateModel(
            name='RunAnalysis',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('part', models.CharField(choices=annotations.models.splits.part_choices, max_length=12)),
                ('version', models.PositiveSmallIntegerField()),
                ('findings', models.JSONField(default=dict)),
                ('made_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='analyses', to='parser_service.trainingrun')),
            ],
            options={
                'ordering': ['run', 'part'],
                'constraints': [models.UniqueConstraint(fields=('run', 'part'), name='analysed_once')],
            },
        ),
        migrations.CreateModel(
            name='Slice',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('name', models.CharField(max_length=80)),
                ('query', models.TextField(blank=True)),
                ('created_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('created_by', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.SET_NULL, to=settings.AUTH_USER_MODEL)),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='slices', to='annotations.world')),
            ],
            options={
                'ordering': ['name'],
                'constraints': [models.UniqueConstraint(fields=('world', 'name'), name='slice_name')],
            },
        ),
        migrations.CreateModel(
            name='ErrorCategory',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('code', models.SlugField(max_length=40)),
                ('name', models.CharField(max_length=60)),
                ('description', models.CharField(blank=True, max_length=300)),
                ('position', models.PositiveSmallIntegerField()),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='error_categories', to='annotations.world')),
                ('slice', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='error_categories', to='parser_service.slice')),
            ],
            options={
                'ordering': ['position', 'id'],
                'constraints': [models.UniqueConstraint(fields=('world', 'code'), name='error_category_code'), models.UniqueConstraint(models.F('world'), django.db.models.functions.text.Lower('name'), name='error_category_name')],
            },
        ),
        migrations.CreateModel(
            name='Review',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('is_proposed', models.BooleanField(default=False)),
                ('answer', models.TextField(blank=True)),
                ('note', models.TextField(blank=True)),
                ('reason', models.TextField(blank=True)),
                ('created_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('changed_at', models.DateTimeField(auto_now=True)),
                ('category', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.CASCADE, related_name='reviews', to='parser_service.errorcategory')),
                ('example', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='reviews', to='annotations.example')),
                ('reviewer', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='reviews', to=settings.AUTH_USER_MODEL)),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='reviews', to='parser_service.trainingrun')),
                ('is_new', models.BooleanField(blank=True, null=True)),
            ],
            options={
                'ordering': ['id'],
                'indexes': [models.Index(fields=['run', 'is_proposed', 'category'], name='parser_serv_run_id_661bb6_idx')],
                'constraints': [models.UniqueConstraint(condition=models.Q(('is_proposed', False)), fields=('run', 'example', 'reviewer'), name='one_review_of_each_reviewer'), models.UniqueConstraint(condition=models.Q(('is_proposed', True)), fields=('run', 'example'), name='one_proposed_review')],
            },
        ),
        migrations.CreateModel(
            name='ExampleColumns',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('part', models.CharField(choices=annotations.models.splits.part_choices, max_length=12)),
                ('data', models.BinaryField()),
                ('split', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='columns', to='annotations.split')),
            ],
            options={
                'ordering': ['split', 'part'],
                'constraints': [models.UniqueConstraint(fields=('split', 'part'), name='example_columns_once')],
            },
        ),
        migrations.CreateModel(
            name='AnswerColumns',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('part', models.CharField(choices=annotations.models.splits.part_choices, max_length=12)),
                ('data', models.BinaryField()),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='columns', to='parser_service.trainingrun')),
            ],
            options={
                'ordering': ['run', 'part'],
                'constraints': [models.UniqueConstraint(fields=('run', 'part'), name='answer_columns_once')],
            },
        ),
        migrations.CreateModel(
            name='Tryout',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('number', models.PositiveIntegerField(default=0)),
                ('text', models.TextField(blank=True)),
                ('runs', models.JSONField(default=list)),
                ('answers', models.JSONField(default=dict)),
                ('before', models.JSONField(blank=True, default=dict)),
                ('is_answered', models.BooleanField(default=True)),
                ('asked_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('person', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='tryouts', to=settings.AUTH_USER_MODEL)),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='tryouts', to='annotations.world')),
            ],
            options={
                'constraints': [models.UniqueConstraint(fields=('world', 'person'), name='one_tryout_of_each_person')],
            },
        ),
        migrations.CreateModel(
            name='Promotion',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('state', models.CharField(choices=parser_service.models.promotions.promotion_state_choices, max_length=10)),
                ('reason', models.CharField(blank=True, max_length=500)),
                ('evidence', models.JSONField(default=dict)),
                ('made_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('decided_at', models.DateTimeField(blank=True, null=True)),
                ('decided_by', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.SET_NULL, to=settings.AUTH_USER_MODEL)),
                ('run', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='promotions', to='parser_service.trainingrun')),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='promotions', to='annotations.world')),
            ],
            options={
                'ordering': ['-id'],
                'indexes': [models.Index(fields=['world', 'state', '-decided_at'], name='parser_serv_world_i_d6d216_idx')],
            },
        ),
        migrations.CreateModel(
            name='ActionNames',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('names', models.JSONField(default=dict)),
                ('version', models.PositiveIntegerField(default=1)),
                ('changed_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('changed_by', models.ForeignKey(null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='+', to=settings.AUTH_USER_MODEL)),
                ('world', models.OneToOneField(on_delete=django.db.models.deletion.CASCADE, related_name='action_names', to='annotations.world')),
            ],
            options={
                'verbose_name_plural': 'action names',
            },
        ),
        migrations.CreateModel(
            name='Dialogue',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('utterance', models.CharField(max_length=500)),
                ('state', models.JSONField()),
                ('phase', models.CharField(max_length=12)),
                ('transcript', models.JSONField(default=list)),
                ('started_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('version', models.PositiveIntegerField(default=1)),
                ('kept_as', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='+', to='annotations.utterance')),
                ('run', models.ForeignKey(null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='+', to='parser_service.trainingrun')),
                ('started_by', models.ForeignKey(null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='dialogues', to=settings.AUTH_USER_MODEL)),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='dialogues', to='annotations.world')),
            ],
            options={
                'ordering': ['-id'],
                'indexes': [models.Index(fields=['world', '-id'], name='parser_serv_world_i_a6245a_idx')],
            },
        ),
        migrations.CreateModel(
            name='OfferedEntity',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('entity_class', models.CharField(max_length=20)),
                ('text', models.CharField(max_length=500)),
                ('alias', models.CharField(blank=True, max_length=500)),
                ('said_in', models.CharField(max_length=500)),
                ('times', models.PositiveIntegerField(default=1)),
                ('state', models.CharField(choices=parser_service.models.dialogues.offer_state_choices, default='waiting', max_length=10)),
                ('offered_at', models.DateTimeField(default=django.utils.timezone.now)),
                ('decided_at', models.DateTimeField(blank=True, null=True)),
                ('decided_by', models.ForeignKey(blank=True, null=True, on_delete=django.db.models.deletion.SET_NULL, related_name='+', to=settings.AUTH_USER_MODEL)),
                ('world', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='offered_entities', to='annotations.world')),
            ],
            options={
                'ordering': ['-id'],
                'indexes': [models.Index(fields=['world', 'state', '-id'], name='parser_serv_world_i_cab5db_idx')],
                'constraints': [models.UniqueConstraint(fields=('world', 'entity_class', 'text', 'alias'), name='one_offer_of_each_entity')],
            },
        ),
    ])]
