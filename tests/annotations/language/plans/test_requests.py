from random import Random

import pytest

from annotations.language.corpus import read_triples
from annotations.language.forms import read_form
from annotations.language.grounding import Anonymizer
from annotations.language.plans import is_qualified, other_requests, says_number
from annotations.language.world import Entity, Ontology, infer_signatures
from tests.annotations.language.corpus.test_rewording import STARTER


def test_a_world_that_knows_an_action_is_asked_for_it():
    kinds = {each.gloss for each in other_requests({})}
    opening = infer_signatures([read_form('( open " <location> " )')])
    assert kinds - {each.gloss for each in other_requests(opening)} == {"open or close something"}


def test_requests_are_made_of_the_commands_of_the_world():
    random = Random(0)
    said = [
        text for each in other_requests({}) for text in each.examples(["go to the <room>"], random)
    ]
    assert not any("{" in text for text in said)
    assert any("don't go to the <room>" in text for text in said)
    assert len(said) == len(set(said)) > 150


@pytest.mark.parametrize(
    "said",
    [
        "don’t bring me the honey",
        "Do not follow Jane",
        "bring me the milk if there is any",
        "if Ann is in the kitchen, greet her",
        "unless somebody objects go to the sink",
        "you need not go to the kitchen",
    ],
)
def test_what_forbids_or_sets_a_condition_is_qualified(said):
    assert is_qualified(said)


@pytest.mark.parametrize(
    "said",
    [
        "I would be glad if you took the jam to Ann",
        "would you mind if I asked for the jam",
        "believe it or not, the jam is in the sink",
        "Ann has not met you, introduce yourself",
        "",
    ],
)
def test_wishes_and_reports_are_not(said):
    assert not is_qualified(said)


def test_hardly_a_paraphrase_of_a_shipped_world_is_qualified():
    said = [
        record.paraphrase
        for file in STARTER.glob("*/paraphrases.txt")
        for record in read_triples(file.read_bytes(), file.name).records
    ]
    assert len(said) > 500
    assert len([text for text in said if is_qualified(text)]) <= 1  # "… if it isn't closed"


@pytest.mark.parametrize(
    ("said", "is_number"),
    [
        ("bring me two apples", True),
        ("bring me both of the apples", True),
        ("bring me 12 apples", True),
        ("bring me one apple", False),
        ("bring me the apple at two", False),
        ("count the apples", False),
    ],
)
def test_a_number_before_a_thing_asks_for_several(said, is_number):
    anonymizer = Anonymizer(Ontology((Entity("object", "apple"),)))
    assert says_number(anonymizer.anonymize(said)) == is_number
