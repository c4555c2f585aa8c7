import pytest

from annotations.language.world import Entity, Ontology
from parser_service.neural.ranker.slots import SlotTerm

HOME = Ontology(
    (
        Entity("object", "apple", (), {"category": "fruits"}),
        Entity("category", "fruits", (), {"singular": "fruit"}),
        Entity("room", "kitchen"),
        Entity("location", "kitchen table"),
    )
)
FORMS = (
    '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )',
    '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )',
    '( bring ( lambda $1 e ( is_a $1 " <category> " ) ) )',
    "UNKNOWN",
)


@pytest.mark.parametrize(
    ("utterance", "scores"),
    [
        ("bring the apple from the kitchen", [0, -1, -3, -2]),
        ("bring the <object> from the <room>", [0, -1, -3, -2]),
        ("bring the apple from the kitchen table", [-2, -1, -3, -2]),
        ("a fruit please", [-1, 0, 0, -1]),
        ("the fruits please", [-3, -2, 0, -1]),
        ("the objects", [-2, -1, 0, 0]),
        ("the object", [-2, -1, -1, 0]),
        ("", [-2, -1, -1, 0]),
    ],
)
def test_each_slot_too_many_or_too_few_costs_one(utterance, scores):
    [measured] = SlotTerm(FORMS, HOME).scores([utterance]).tolist()
    assert measured == scores


@pytest.mark.parametrize(
    ("utterance", "form", "is_more"),
    [
        ("bring the apple from the kitchen", 0, False),
        ("bring the apple from the kitchen", 1, True),  # where from?
        ("bring the apple to the kitchen table, from the kitchen", 0, True),
        ("bring the apple, the apple from the kitchen", 0, False),  # said twice
        ("bring two apples from the kitchen", 0, True),
        ("a fruit please", 1, False),  # may be either class
        ("a fruit please", 2, False),
        ("please", 0, False),
    ],
)
def test_an_entity_without_a_slot_asks_for_more_than_the_form(utterance, form, is_more):
    assert SlotTerm(FORMS, HOME).asks_for_more(utterance, FORMS[form]) == is_more


def test_a_number_that_the_form_says_asks_for_no_more():
    form = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) 2 )'
    assert not SlotTerm(FORMS, HOME).asks_for_more("find two apples", form)


def test_one_more_entity_of_a_class_is_scored_with_its_slot():
    term = SlotTerm(FORMS, HOME)
    [whole] = term.scores(["bring the apple from the kitchen"]).tolist()
    assert term.scores_with("bring the apple", ["room"]).tolist() == whole
    assert term.named("bring the apple from the <room>") == {"object", "room"}
