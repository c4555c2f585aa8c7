"""The database refuses an entity of people that is there already, and more people than an invitation has places."""

from __future__ import annotations

from django.db import migrations, models
from django.db.models.fields.json import KeyTextTransform
from django.db.models.functions import Coalesce, Left, Lower


def beginning_of(attribute):
    value = Coalesce(KeyTextTransform(attribute, "attributes"), models.Value(""))
    return Left(Lower(value), 60)


def give_places(apps, schema_editor):
    """An invitation has as many places as people have joined by it, at least."""
    invitations = apps.get_model("annotations", "Invitation").objects
    invitations.filter(joined__gt=models.F("places")).update(places=models.F("joined"))


class Migration(migrations.Migration):
    dependencies = [("annotations", "0032_repeated_entities")]
    operations = [
        migrations.RunPython(give_places, migrations.RunPython.noop),
        migrations.AddConstraint(
            model_name="entity",
            constraint=models.UniqueConstraint(
                "ontology",
                "entity_class",
                Lower("text"),
                beginning_of("room"),
                beginning_of("gender"),
                condition=models.Q(source=""),
                name="entity_once",
                violation_error_message="This entity is there already.",
            ),
        ),
        migrations.AddConstraint(
            model_name="invitation",
            constraint=models.CheckConstraint(
                condition=models.Q(joined__lte=models.F("places")), name="places_of_an_invitation"
            ),
        ),
    ]
