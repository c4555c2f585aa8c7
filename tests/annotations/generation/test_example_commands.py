"""Examples of a world's commands: each with another action first, and with entities."""

from __future__ import annotations

import pytest

from annotations.generation.example_commands import example_commands
from annotations.models import Command, Entity, LogicalForm, Ontology

FORMS = (
    ("bring", "bring me the <object>"),
    ("bring", "fetch the <object>"),
    ("go", "go from the <room> , please , to the <room2>"),
    ("UNKNOWN", "sing"),
    ("bring", "could you please bring me the <object>"),
    ("follow", "follow <name>"),
)


@pytest.fixture
def described(world):
    for position, (head, text) in enumerate(FORMS):
        body = "UNKNOWN" if head == "UNKNOWN" else f"( {head} {position} )"
        form = LogicalForm.objects.create(
            world=world, text=body, head_predicate=head, depth=1, length=3
        )
        Command.objects.create(
            world=world,
            logical_form=form,
            anonymized_text=text,
            length=len(text),
            position=position,
        )
    return world


def add(world, *entities: tuple[str, str]) -> None:
    ontology, _ = Ontology.objects.get_or_create(world=world)
    for position, (entity_class, text) in enumerate(entities):
        Entity.objects.create(
            ontology=ontology, entity_class=entity_class, text=text, position=position
        )


def test_each_has_another_action_and_entities_of_the_world(described):
    add(described, ("object", "tea"), ("room", "attic"), ("room", "hall"), ("room", "cellar"))
    assert example_commands(described, 5) == [
        "bring me the tea",
        "go from the attic, please, to the cellar",
    ]
    assert example_commands(described, 1) == ["bring me the tea"]


def test_a_command_that_says_less_than_a_robot_needs_is_no_example(described):
    add(described, ("object", "tea"), ("room", "attic"), ("room", "cellar"))
    for form in described.logical_forms.filter(head_predicate="bring"):
        form.text = f"( bring UNKNOWN {form.pk} )"
        form.save()
    assert example_commands(described, 5) == ["go from the attic, please, to the cellar"]


def test_a_world_without_commands_or_entities_has_none(world, described):
    assert example_commands(described, 5) == []
