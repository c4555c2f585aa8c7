from django.db import migrations, models

import annotations.models.people


class Migration(migrations.Migration):
    """Tokens that exist keep doing all that their owners may do."""

    dependencies = [
        ('annotations', '0020_splits_frozen_anew'),
    ]

    operations = [
        migrations.AddField(
            model_name='apitoken',
            name='scope',
            field=models.CharField(choices=annotations.models.people.scope_choices, default='admin', max_length=10),
            preserve_default=False,
        ),
    ]
