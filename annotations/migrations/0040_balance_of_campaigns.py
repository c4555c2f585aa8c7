"""Campaigns balance forms, or lines of the templates."""

from django.db import migrations, models

import annotations.models.campaigns


class Migration(migrations.Migration):
    dependencies = [("annotations", "0039_campaign_limits")]

    operations = [
        migrations.AddField(
            model_name="campaign",
            name="balance",
            field=models.CharField(
                choices=annotations.models.campaigns.balance_choices,
                db_default="forms",
                default="forms",
                max_length=5,
            ),
        ),
        migrations.AddField(
            model_name="campaignprompt",
            name="line",
            field=models.TextField(blank=True, db_default="", default=""),
        ),
    ]
