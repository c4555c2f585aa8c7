"""What makes another request of a command, and what stopped an utterance."""

from pathlib import Path
from time import process_time

import pytest

from annotations.language.grounding import Anonymizer
from annotations.language.plans import NearCommands, StoppingWords, objections
from annotations.language.plans.stating import states
from annotations.language.world import Entity, Ontology
from tests.annotations.language.plans.wordings import FINE, FINE_TOO, NOT_TO_DO, NOT_TO_DO_TOO

ENTITIES = {
    "object": ("cola", "apple", "orange", "milk", "sponge", "7up", "soap", "cup", "spoon"),
    "name": ("Charlie", "Robin", "Angel", "Jules"),
    "room": ("kitchen", "office", "bedroom", "bathroom", "living room"),
    "location": ("kitchen table", "desk", "sink", "sofa", "exit", "fridge", "entrance"),
}
ONTOLOGY = Ontology(tuple(Entity(name, text) for name, texts in ENTITIES.items() for text in texts))
ANONYMIZER = Anonymizer(ONTOLOGY)
VOCABULARY = frozenset(
    ["bring", "me", "the", "from", "to", "go", "find", "put", "on", "and", "take"]
)


def codes(said):
    return {each.code for each in objections(ANONYMIZER.anonymize(said))}


@pytest.mark.parametrize(
    ("code", "said"), [(code, said) for code, group in NOT_TO_DO.items() for said in group]
)
def test_another_request_is_named(code, said):
    assert code in codes(said)


@pytest.mark.parametrize("said", FINE)
def test_courtesy_is_no_objection(said):
    assert not codes(said)


def lines(name):
    text = (Path(__file__).parent / name).read_text(encoding="utf-8")
    return [line for line in text.splitlines() if not line.startswith("#")]


@pytest.mark.parametrize("said", lines("no_requests.txt"))
def test_what_only_tells_something_is_no_request(said):
    for text in (said, said.upper(), f"  {said} ...", said.replace("'", "’")):
        assert "statement" in codes(text), text


@pytest.mark.parametrize("said", lines("stated_requests.txt"))
def test_what_is_wanted_or_due_is_a_request_however_it_is_said(said):
    for text in (said, said.upper(), f"{said}!"):
        assert "statement" not in codes(text), text


@pytest.mark.parametrize(
    "word", ["now ", "i ", "the a ", "was ", "and ", ", ", "_ ", "i think ", "really "]
)
def test_a_long_text_is_looked_at_in_linear_time(word):
    began = process_time()
    states(word * (20_000 // len(word)))
    assert process_time() - began < 1


def test_other_wordings_seldom_raise_a_false_alarm_and_seldom_pass():
    assert len([said for said in FINE_TOO if codes(said)]) <= 0.05 * len(FINE_TOO)
    assert len([said for said in NOT_TO_DO_TOO if not codes(said)]) <= 0.05 * len(NOT_TO_DO_TOO)


def test_an_objection_says_where_it_stands():
    said = "go to the kitchen, but don’t take the cola"
    [objection] = objections(ANONYMIZER.anonymize(said))
    assert said[objection.start : objection.end].startswith("n’t take")
    [number] = objections(ANONYMIZER.anonymize("bring me two apples"))
    assert number.code == "number" and "two apples" in number.message


@pytest.mark.parametrize(
    ("said", "found"),
    [
        ("bring me the flurb", [("unknown_word", "flurb")]),
        ("asdf qwer", [("unknown_word", "asdf qwer")]),
        ("find Wolfgang in the kitchen", [("unknown_name", "Wolfgang")]),
        ("take Anna Maria to the zonk", [("unknown_name", "Anna Maria"), ("unknown_word", "zonk")]),
        ("FIND THE COLA", []),
        ("bring me the colas from the desk, please", []),
        ("put 3 <object> on the desk", []),
        ("", []),
    ],
)
def test_what_nobody_knows_is_named(said, found):
    stops = StoppingWords(ONTOLOGY, VOCABULARY).in_(ANONYMIZER.anonymize(said))
    assert [(each.code, said[each.start : each.end]) for each in stops] == found


def test_without_a_grammar_no_word_is_called_unknown():
    assert StoppingWords(ONTOLOGY, ()).in_(ANONYMIZER.anonymize("bring me the flurb")) == ()


def test_near_commands_share_telling_words():
    near = NearCommands(
        [
            "bring me the <object>",
            "go to the <room>",
            "follow <name> to the <room>",
            "please go to the <room>",
        ]
    )
    assert near.nearest(ANONYMIZER.anonymize("folow Jules"))[0] == "follow <name> to the <room>"
    assert near.nearest(ANONYMIZER.anonymize("go kitchen"), 1) == ("go to the <room>",)
    assert near.nearest(ANONYMIZER.anonymize("asdf qwer")) == ()
    assert NearCommands([]).nearest(ANONYMIZER.anonymize("go")) == ()


def test_of_two_words_that_are_spelt_alike_the_first_counts_in_every_process():
    near = NearCommands(["catch and match the <object>", "match the <object>"])
    chosen = near.nearest(ANONYMIZER.anonymize("batch cola"), 1)
    assert chosen == ("catch and match the <object>",)
