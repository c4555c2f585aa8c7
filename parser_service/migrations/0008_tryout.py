import django.db.models.deletion
import django.utils.timezone
from django.conf import settings
from django.db import migrations, models


class Migration(migrations.Migration):

    dependencies = [
        ('annotations', '0018_command_proposals'),
        ('parser_service', '0007_predictions_and_training'),
        migrations.swappable_dependency(settings.AUTH_USER_MODEL),
    ]

    operations = [
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
    ]
