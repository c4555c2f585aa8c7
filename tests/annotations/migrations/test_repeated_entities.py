"""Entities that two people once added at the same moment become one, and nothing that they said is lost."""

from __future__ import annotations

from importlib import import_module

import pytest
from django.apps import apps
from django.db import IntegrityError, connection, transaction

from annotations.models import Entity, Ontology

migration = import_module("annotations.migrations.0032_repeated_entities")


@pytest.fixture
def add(world):
    """A function that stores an entity, as if the database did not look for repeated ones yet."""
    with connection.cursor() as cursor:
        cursor.execute("DROP INDEX entity_once")
    ontology = Ontology.objects.create(world=world)

    def store(text: str, entity_class: str = "object", **values) -> Entity:
        position = Entity.objects.count()
        return Entity.objects.create(
            ontology=ontology, entity_class=entity_class, text=text, position=position, **values
        )

    return store


def test_repeated_entities_become_the_first_one(add):
    first = add("mug", aliases=["cup"], attributes={"category": "dishes"})
    second = add("Mug", aliases=["beaker", "cup"], attributes={"category": "?", "type": "like"})
    third = add("mug")
    migration.merge_repeated_entities(apps, None)
    kept = Entity.objects.get()
    assert (kept.pk, kept.text, kept.aliases) == (first.pk, "mug", ["cup", "beaker"])
    assert kept.attributes == {"category": "dishes", "type": "like"}
    gone = Entity.history.filter(history_type="-")
    assert {(each.id, each.text) for each in gone} == {(second.pk, "Mug"), (third.pk, "mug")}
    assert (kept.version, kept.history.get().aliases) == (2, kept.aliases)


def test_entities_that_differ_and_those_of_files_stay(add):
    add("sink", "location", attributes={"room": "kitchen"})
    add("sink", "location", attributes={"room": "bath"})
    add("sink")
    for _ in range(2):
        add("sink", "location", attributes={"room": "bath"}, source="locations.xml")
    migration.merge_repeated_entities(apps, None)
    assert Entity.objects.count() == 5
    assert not Entity.history.exists()


def test_the_database_refuses_a_repeated_entity_of_people(world):
    ontology = Ontology.objects.create(world=world)
    values = {"ontology": ontology, "entity_class": "name", "text": "alex"}
    for position, gender in enumerate(("male", "female")):
        Entity.objects.create(**values, position=position, attributes={"gender": gender})
    with pytest.raises(IntegrityError), transaction.atomic():
        Entity.objects.create(**values, position=2, attributes={"gender": "Male"})
    for position in (3, 4):
        Entity.objects.create(**values, position=position, source="names.xml")
