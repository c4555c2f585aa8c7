"""Several commands in one utterance, by the grammar oracle of the world ``competition``."""

from __future__ import annotations

import re
from functools import cache
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from annotations.exchange.shipped_worlds import SHIPPED_WORLDS
from annotations.language.templates import (
    Balance,
    Language,
    SampleRequest,
    read_generator_folder,
)
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.oracle import GrammarOracle
from parser_service.parsers.several import pieces_of
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.parser_service.parsers.joins import TALK, WAYS
from tests.timing import least_seconds

FOLDER = SHIPPED_WORLDS["competition"].folder
# The name of an entity in them: "be a" is heard as Bea, and "a game" as a category.
NAMING = {each for each in WAYS if "Be a dear" in each or "play a game" in each}

FRAGMENTS = (
    *("bring me the cocoa", "greet Maria in the lobby", "the", "and then", ". ", ", ", "or", "if"),
    *("don't", "number two", "🙂", "\n", "find the", "in the galley", "how to", ": "),
)


@cache
def oracle() -> GrammarOracle:
    ontology, _ = read_ontology_folder(FOLDER)
    categories = read_generator_folder(FOLDER).categories()
    return GrammarOracle(knowledge=Knowledge(ontology=ontology, grammar=categories))


@cache
def commands() -> tuple[str, ...]:
    """Commands of every line of the templates, with entities."""
    random = Random(0)
    ontology, _ = read_ontology_folder(FOLDER)
    named: dict[str, list[str]] = {}
    for entity in ontology.entities:
        named.setdefault(entity.entity_class, []).append(entity.text)
    categories = read_generator_folder(FOLDER).categories()
    sample = Language(categories).sample(SampleRequest(200, 0, Balance.LINES)).generated
    texts = (each.command.replace(" ,", ",") for each in sample.expansions)
    return tuple(re.sub(r"<(\w+)>", lambda it: random.choice(named[it[1]]), text) for text in texts)


def answers(texts):
    return [[(each.form, each.values) for each in found] for found in oracle().predict(texts)]


def inside(command):
    return command[:1].lower() + command[1:]


@pytest.mark.parametrize("way", WAYS)
def test_three_commands_are_found_however_they_are_joined(way):
    three = Random(way).sample(commands(), 3)
    pieces = pieces_of(way.format(*map(inside, three)), oracle())
    understood = [each.text for each in pieces if each.is_understood]
    assert answers(understood) == answers(three)
    assert len(pieces) == 3 or way in NAMING


@pytest.mark.parametrize(("said", "understood"), TALK.items())
def test_nothing_is_cut_out_of_what_asks_for_something_else(said, understood):
    pieces = pieces_of(said, oracle())
    assert [inside(each.text) for each in pieces if each.is_understood] == understood


TWO = ("greet Maria in the lobby", "bring me the cocoa")


@pytest.mark.parametrize(
    "asked",
    [
        *(" and walk after her", " and tickle her", ", then polish her shoes", " and wait there"),
        *(" and sing", " and shake hands", ", then keep an eye on it", " and after that hug him"),
        *(", accompany them", " and leave", ", wait for her and bring me the quince"),
    ],
)
def test_what_is_asked_last_is_not_dropped_whatever_its_verb(asked):
    pieces = pieces_of(" and ".join(TWO) + asked, oracle())
    assert [each.text for each in pieces[:2]] == [*TWO]
    assert not pieces[2].is_understood


@pytest.mark.parametrize(
    "closing",
    [
        *(" and that is all", ", please", ", thank you", " and be quick", " and hurry up"),
        *(" and quickly", ", then you are done", " and we are good", " and do it quickly"),
    ],
)
def test_a_closing_asks_for_nothing(closing):
    pieces = pieces_of(" and ".join(TWO) + closing, oracle())
    assert all(each.is_understood for each in pieces) and len(pieces) == 2


def test_a_command_of_the_language_stays_whole():
    for command in commands():
        (piece,) = pieces_of(command, oracle())
        assert (piece.text, piece.is_understood) == (command, True)


def test_a_learned_parser_judges_what_the_grammar_does_not_derive():
    said = "greet Maria in the lobby. Fling the cocoa at Otto, and then chuck the quince. "
    said += "Bring me the cocoa. Do not go."
    known = {"Fling the cocoa at Otto", "chuck the quince", "Do not go"}
    pieces = pieces_of(said, oracle(), lambda texts: [0.0 if t in known else None for t in texts])
    assert [(each.text, each.is_understood) for each in pieces] == [
        ("greet Maria in the lobby", True),
        ("Fling the cocoa at Otto", True),
        ("chuck the quince", True),
        ("Bring me the cocoa", True),
        ("Do not go", False),
    ]


@pytest.mark.parametrize(
    "said",
    [
        "bring me the cocoa and hand Otto the quince",
        "Bring me the cocoa. Hand Otto the quince.",
        "greet Maria in the lobby, hand Otto the quince and bring me the cocoa",
    ],
)
def test_one_command_in_other_words_is_not_cut(said):
    """The grammar derives a part of it only, and a learned parser all of it."""
    whole = [said, said.rstrip(".")]
    pieces = pieces_of(said, oracle(), lambda texts: [0.0 if t in whole else None for t in texts])
    assert [(each.text.rstrip("."), each.is_understood) for each in pieces] == [
        (said.rstrip("."), True)
    ]


def test_without_a_grammar_the_learned_parser_alone_judges():
    def judge(texts):
        return [0.0 if text in ("wave", "sit down") else None for text in texts]

    assert [each.text for each in pieces_of("wave and then sit down", None, judge)] == [
        "wave",
        "sit down",
    ]
    (piece,) = pieces_of("wave and then sit down", None)
    assert not piece.is_understood


@pytest.mark.parametrize("said", ["and greet Maria in the lobby ", "if you find the cocoa ", ". "])
def test_a_long_text_takes_less_than_a_second(said):
    text = (said * 1_000)[:1_000]
    assert least_seconds(lambda: pieces_of(text, oracle()), 2) < 1


@settings(max_examples=50)
@given(
    st.lists(
        st.sampled_from(FRAGMENTS),
        max_size=12,
    ).map(" ".join)
)
def test_pieces_lie_in_the_text_in_order(text):
    end = 0
    for piece in pieces_of(text, oracle()):
        assert end <= piece.start < piece.end <= len(text)
        assert piece.text == text[piece.start : piece.end]
        assert oracle().understands(piece.text) or not piece.is_understood
        end = piece.end
