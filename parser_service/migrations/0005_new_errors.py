from django.db import migrations, models


class Migration(migrations.Migration):

    dependencies = [
        ('parser_service', '0004_error_analysis'),
    ]

    operations = [
        migrations.AddField(
            model_name='review',
            name='is_new',
            field=models.BooleanField(blank=True, null=True),
        ),
        migrations.AddIndex(
            model_name='prediction',
            index=models.Index(fields=['run', 'rank', 'is_exact_match', 'example'], name='answers_in_order'),
        ),
        migrations.RemoveIndex(
            model_name='prediction',
            name='parser_serv_run_id_084279_idx',
        ),
    ]
