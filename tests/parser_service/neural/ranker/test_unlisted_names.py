"""What entities are found in other words, by the encoder that comes with an installation."""

import pytest

from annotations.language.forms import DEFAULT_CLASSES, EntityClass
from annotations.language.world import Entity, Ontology
from parser_service.neural.pretrained import load_encoder
from parser_service.neural.ranker.form_ranker import values_of
from parser_service.neural.ranker.unlisted_names import UnlistedNames
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.parsers.hyperparameters.ranker import DEFAULT_ENCODER

POSE = EntityClass("pose", "pose", "poses", 20, "pose", is_closed=True)
HOME = Ontology(
    (
        Entity("gesture", "waving"),
        Entity("gesture", "raising their left arm"),
        Entity("gesture", "raising their right arm"),
        Entity("gesture", "pointing to the left", ("pointing left",)),
        Entity("pose", "sitting"),
        Entity("pose", "standing"),
        Entity("object", "apple"),
    ),
    DEFAULT_CLASSES.with_rows([POSE]),
)


@pytest.fixture(scope="module")
def encoder():
    return SentenceEncoder.of(load_encoder(DEFAULT_ENCODER))


@pytest.mark.parametrize(
    ("said", "found"),
    [
        ("follow the one with the right arm in the air", {"gesture": "raising their right arm"}),
        ("someone waves at you, greet them", {"gesture": "waving"}),
        ("guide whoever sits next to the door", {"pose": "sitting"}),
        ("bring me the aple from the kitchen", {"object": "apple"}),
        ("bring me the maple from the kitchen", {}),  # a word of its own
        ("bring me something from the kitchen", {}),
        ("", {}),
        ("word " * 200, {}),
    ],
)
def test_a_member_is_found_in_other_words(encoder, said, found):
    unlisted = UnlistedNames(HOME)
    assert {"gesture", "pose", "object"} <= unlisted.tokens
    assert unlisted.find(encoder, said, ["gesture", "pose", "object"]) == found


def test_a_value_goes_to_the_one_slot_of_its_class():
    form = '( follow ( lambda $1 e ( gesture $1 " <gesture> " ) ( at $1 " <room> " ) ) )'
    assert values_of(form, {"gesture": "waving"}) == ("waving", None)
    assert values_of(form, {"pose": "sitting"}) == ()
    assert values_of(form.replace("<room>", "<gesture>"), {"gesture": "waving"}) == ()
