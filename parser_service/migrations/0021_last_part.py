"""A language model that a world asks last."""

from django.db import migrations, models


class Migration(migrations.Migration):

    dependencies = [
        ('parser_service', '0020_answering'),
    ]

    operations = [
        migrations.AddField(
            model_name='answering',
            name='asks_language_model',
            field=models.BooleanField(default=False),
        ),
    ]
