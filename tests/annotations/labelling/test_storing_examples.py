"""Lines stored as a world: all of it or nothing, extended later, and the lines kept with their forms."""

from __future__ import annotations

import pytest

from annotations.labelling.storing_examples import NoExamples, StoredExamples, store_examples
from annotations.language.induction import propose
from annotations.models import (
    Command,
    Entity,
    Label,
    Predicate,
    Production,
    SemanticTemplate,
    TaskCategory,
    World,
)
from annotations.rows.history import history_of
from annotations.rows.known_world import known_world_of

GREENHOUSE = """
please water the [tomatoes](plant) in [bed two](bed)
irrigate the [roses] = water
go to the [shed](place)
go to the [shed] and water the [roses]
take the [shears](tool) and bring them to the [shed]
"""


def test_lines_become_a_world(world, admin):
    stored = store_examples(world, GREENHOUSE, admin)
    assert stored == StoredExamples(
        classes=4, entities=5, predicates=4, productions=6, templates=5, utterances=5
    )
    category = TaskCategory.objects.get(grammar__world=world)
    assert category.name == "commands"
    assert list(world.entity_classes.order_by("position").values_list("token", flat=True))[-4:] == [
        *("plant", "bed", "place", "tool")
    ]
    commands = Command.objects.filter(world=world).values_list("anonymized_text", flat=True)
    assert {"irrigate the <plant>", "go to the <place>"} <= set(commands)
    for model in (Entity, Predicate, Production, SemanticTemplate):
        entries = history_of(model).values_list("history_user", "history_type")
        assert set(entries) == {(admin.pk, "+")}


def test_the_lines_are_kept_with_their_forms(world, admin):
    store_examples(world, GREENHOUSE, admin)
    forms = dict(world.utterances.values_list("text", "logical_form"))
    assert forms == {
        "please water the tomatoes in bed two": '( water " <plant> " " <bed> " )',
        "irrigate the roses": '( water " <plant> " )',
        "go to the shed": '( go " <place> " )',
        "go to the shed and water the roses": '( sequence ( go " <place> " ) ( water " <plant> " ) )',
        "take the shears and bring them to the shed": "",
    }
    assert Label.objects.accepted().filter(annotator=admin).count() == 4


def test_lines_of_an_annotator_wait_for_a_label(world, annotator):
    store_examples(world, "water the [roses](plant)", annotator)
    assert not Label.objects.exists()
    assert world.utterances.unlabelled().count() == 1


@pytest.mark.parametrize(
    "lines",
    [
        "",
        "# a comment",
        "water the [roses",
        "water the [roses](plant)\nwater the []",
        "water the [roses]",  # nobody has said what they are
        "3 [x](word)",
        "go to the [a|b](place)",
        "do 3 [x](word) = (do",
    ],
)
def test_nothing_is_stored_where_a_line_is_no_example(world, admin, lines):
    with pytest.raises(NoExamples) as refused:
        store_examples(world, lines, admin)
    assert refused.value.problems
    assert not Entity.objects.exists() and not Predicate.objects.exists()
    assert not world.utterances.exists() and not TaskCategory.objects.exists()


def test_later_lines_extend_the_world(world, admin):
    store_examples(world, GREENHOUSE, admin)
    more = "water the [basil]\nirrigate the [roses] at [noon](time)\nfeed the [roses] with [compost](food)"
    known = known_world_of(world)
    proposal = propose(more, known)
    assert proposal.understood == ()
    assert [each.rule.words for each in proposal.templates] == [
        ("irrigate", "the", "<plant>", "at", "<time>"),
        ("feed", "the", "<plant>", "with", "<food>"),
    ]
    stored = store_examples(world, more, admin)
    assert stored == StoredExamples(
        classes=2, entities=3, predicates=2, productions=2, templates=2, utterances=3
    )
    assert TaskCategory.objects.filter(grammar__world=world).count() == 1
    again = propose(GREENHOUSE, known_world_of(World.objects.get(pk=world.pk)))
    assert again.understood == (2, 3, 4, 5, 6)
    assert not again.templates


def test_a_predicate_takes_other_arguments_as_well(world, admin):
    store_examples(world, "water the [roses](plant)", admin)
    stored = store_examples(world, "water the [roses] in [bed two](bed)", admin)
    assert stored.changed == 1 and stored.predicates == 0
    assert Predicate.objects.get().signatures == [["plant"], ["plant", "bed"]]


def test_the_same_form_stores_once(world, admin):
    assert store_examples(world, "water the [roses](plant)", admin, once="key")
    assert store_examples(world, "water the [roses](plant)", admin, once="key") is None
    assert SemanticTemplate.objects.count() == 1
