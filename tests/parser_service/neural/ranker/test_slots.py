import pytest

from annotations.language.ontology import Entity, Ontology
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
