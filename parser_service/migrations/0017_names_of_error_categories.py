"""A world has one error category of a name; a second one is numbered."""

from __future__ import annotations

from itertools import count

from django.db import migrations, models
from django.db.models.functions import Lower

LONGEST_NAME = 60


def number_repeated_names(apps, schema_editor):
    """Give each category after the first of its name a number: ``slip``, ``slip (2)``."""
    taken = set()
    for row in apps.get_model("parser_service", "ErrorCategory").objects.order_by("position", "id"):
        endings = ("" if number == 1 else f" ({number})" for number in count(1))
        names = (row.name[: LONGEST_NAME - len(ending)] + ending for ending in endings)
        name = next(name for name in names if (row.world_id, name.lower()) not in taken)
        taken.add((row.world_id, name.lower()))
        if name != row.name:
            row.name = name
            row.save(update_fields=["name"])


class Migration(migrations.Migration):
    dependencies = [
        ("annotations", "0033_what_is_there_once"),
        ("parser_service", "0016_sqlite_holds_limits"),
    ]
    operations = [
        migrations.RunPython(number_repeated_names, migrations.RunPython.noop),
        migrations.AddConstraint(
            model_name="errorcategory",
            constraint=models.UniqueConstraint("world", Lower("name"), name="error_category_name"),
        ),
    ]
