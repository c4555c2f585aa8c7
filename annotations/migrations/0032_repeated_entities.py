"""Merges entities that people have added twice at the same moment, before the database refuses them."""

from __future__ import annotations

from django.db import migrations, models
from django.db.models.fields.json import KeyTextTransform
from django.db.models.functions import Coalesce, Left, Lower
from django.utils import timezone

REASON = "merged: it was there twice"


def beginning_of(attribute):
    value = Coalesce(KeyTextTransform(attribute, "attributes"), models.Value(""))
    return Left(Lower(value), 60)


def merge_repeated_entities(apps, schema_editor):
    """Keep the first of rows that say the same, with the other names and attributes of the rest, which are
    deleted. The history of each keeps what it was."""
    entities = apps.get_model("annotations", "Entity").objects.filter(source="")
    names = ("ontology", "entity_class", "low", "room", "gender")
    compared = entities.annotate(
        low=Lower("text"), room=beginning_of("room"), gender=beginning_of("gender")
    )
    counted = compared.order_by().values(*names).annotate(count=models.Count("pk"))
    for group in counted.filter(count__gt=1):
        same = {name: group[name] for name in names}
        first, *others = compared.filter(**same).order_by("position")
        merge(apps, first, others)


def merge(apps, first, others):
    aliases, attributes = list(first.aliases), dict(first.attributes)
    for other in others:
        aliases += [alias for alias in other.aliases if alias not in aliases]
        attributes = {**other.attributes, **attributes}
        keep(apps, other, "-")
        other.delete()
    if (aliases, attributes) != (first.aliases, first.attributes):
        first.aliases, first.attributes = aliases, attributes
        first.version += 1
        first.save()
        keep(apps, first, "~")


def keep(apps, row, kind):
    columns = [field.attname for field in row._meta.concrete_fields]
    apps.get_model("annotations", "HistoricalEntity").objects.create(
        history_date=timezone.now(),
        history_type=kind,
        history_change_reason=REASON,
        **{name: getattr(row, name) for name in columns},
    )


class Migration(migrations.Migration):
    dependencies = [("annotations", "0031_work_of_who_has_left")]
    operations = [migrations.RunPython(merge_repeated_entities, migrations.RunPython.noop)]
