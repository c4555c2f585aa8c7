"""The predicates that were sequences by their name are declared as such."""

from __future__ import annotations

from django.db import migrations

NAMES = ("sequence", "and")


def declare(apps, schema_editor):
    Predicate = apps.get_model("annotations", "Predicate")
    rows = Predicate.objects.using(schema_editor.connection.alias)
    rows.filter(kind="action", name__in=NAMES).update(kind="sequence")


def take_back(apps, schema_editor):
    Predicate = apps.get_model("annotations", "Predicate")
    rows = Predicate.objects.using(schema_editor.connection.alias)
    rows.filter(kind="sequence").update(kind="action")


class Migration(migrations.Migration):
    dependencies = [("annotations", "0024_audit_log")]

    operations = [migrations.RunPython(declare, take_back)]
