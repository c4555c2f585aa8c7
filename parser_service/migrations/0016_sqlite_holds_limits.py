"""SQLite's tables get the constraints that new ones are made with: lengths of texts, ranges of numbers.

PostgreSQL holds them already. A table with a row beyond a limit stays as it is, so that nothing is lost;
``manage.py backup`` names the row.
"""

from __future__ import annotations

from django.db import IntegrityError, migrations, transaction
from django.db.models.functions import Length

APPS = ("annotations", "parser_service")


def rebuild(apps, schema_editor):
    if schema_editor.connection.vendor != "sqlite":
        return
    using = schema_editor.connection.alias
    # They are computed anew when somebody asks; one release stored some for commands beyond the limit.
    proposals = apps.get_model("annotations", "CommandProposal").objects.using(using)
    proposals.annotate(characters=Length("command")).filter(characters__gt=500).delete()
    for app in APPS:
        for model in apps.get_app_config(app).get_models(include_auto_created=True):
            if model._meta.managed and not model._meta.proxy:
                _rebuild_table(model, schema_editor)


def _rebuild_table(model, schema_editor):
    deferred = list(schema_editor.deferred_sql)
    table = model._meta.db_table
    with schema_editor.connection.cursor() as cursor:
        cursor.execute("SELECT seq FROM sqlite_sequence WHERE name = %s", [table])
        last_key = cursor.fetchone()
    try:
        with transaction.atomic(using=schema_editor.connection.alias):
            schema_editor._remake_table(model)
            # Keys of deleted rows are never used again: their history is kept by them.
            if last_key is not None:
                with schema_editor.connection.cursor() as cursor:
                    cursor.execute("DELETE FROM sqlite_sequence WHERE name = %s", [table])
                    cursor.execute("INSERT INTO sqlite_sequence VALUES (%s, %s)", [table, *last_key])
    except IntegrityError as error:
        schema_editor.deferred_sql[:] = deferred
        print(
            f"\n  {table} holds a row beyond a limit ({error}) and stays as it is. "
            "“manage.py backup” names the row.",
            end="",
        )


class Migration(migrations.Migration):
    dependencies = [
        ("parser_service", "0015_predictions_say_what_was_cut"),
        ("annotations", "0030_uploads_and_deleted_utterances"),
    ]

    operations = [migrations.RunPython(rebuild, migrations.RunPython.noop)]
