"""Of answers that are about equally good, the one that the entities of the utterance fill comes first."""

from __future__ import annotations

import json

import pytest

from annotations.exchange.starter_world import load_starter_world
from annotations.language.corpus import Criterion
from annotations.language.forms import canonical_text, read_form
from annotations.language.world import Entity, Ontology
from parser_service.parsers.interface import Candidate, ScoreKind
from parser_service.serving.metrics import Metrics
from parser_service.serving.parse_answers import read_answers
from parser_service.serving.shelf import Shelf
from tests.parser_service.served import trained_run
from tests.parser_service.serving.test_answer_writing import compare, language_of

HOME = Ontology((Entity("object", "hammer"), Entity("room", "kitchen"), Entity("location", "desk")))


def form(text: str) -> str:
    return canonical_text(read_form(text))


FETCH = form('( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )')
IN_ROOM = form('( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )')
AT_PLACE = form('( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <location> " ) ) )')
IN_CELLAR = form('( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " cellar " ) ) )')
SAID = "bring me the hammer from the kitchen"


@pytest.fixture(scope="module")
def language():
    return language_of(HOME)


def order(language, ranked, kind, text=SAID):
    heard = language.anonymizer.anonymize(text)
    candidates = [Candidate(form, score) for form, score in ranked]
    answers = read_answers(heard, text, candidates, language, kind).answers
    return [answer.form for answer in answers]


def test_an_open_slot_comes_after_a_filled_one(language):
    ranked = [(AT_PLACE, 0.5), (IN_ROOM, 0.5)]
    assert order(language, ranked, ScoreKind.SIMILARITY) == [IN_ROOM, AT_PLACE]


@pytest.mark.parametrize("kind", [ScoreKind.SIMILARITY, ScoreKind.LOG_PROBABILITY, ""])
def test_what_a_robot_can_do_comes_first_of_what_fits_equally_well(language, kind):
    """Nobody knows where the cellar is, so that both plans of the first one have a problem."""
    ranked = [(IN_CELLAR, 0.5), (FETCH, 0.5)]
    assert order(language, ranked, kind, "bring me the hammer") == [FETCH, IN_CELLAR]
    clear = [(IN_CELLAR, -0.1), (FETCH, -0.9)]
    assert order(language, clear, kind, "bring me the hammer") == [IN_CELLAR, FETCH]


def test_what_a_robot_can_do_comes_before_what_names_more(language):
    ranked = [(IN_CELLAR, 0.5), (AT_PLACE, 0.5), (FETCH, 0.5)]
    text = "bring me the hammer from the cellar near the desk or the kitchen"
    assert order(language, ranked, ScoreKind.SIMILARITY, text)[0] == FETCH


def test_executable_plans_are_counted(language):
    heard = language.anonymizer.anonymize("bring me the hammer")
    candidates = [Candidate(each, 0.5) for each in (FETCH, IN_CELLAR, AT_PLACE, "( bring")]
    answers = read_answers(heard, "", candidates, language, ScoreKind.SIMILARITY).answers
    counts = {each.form: each.executable_plans for each in answers}
    assert counts == {FETCH: 2, IN_CELLAR: 0, AT_PLACE: 0, "( bring": 0}


def test_a_form_that_leaves_an_entity_out_comes_after_one_that_takes_all(language):
    ranked = [(FETCH, 0.5), (IN_ROOM, 0.5)]
    assert order(language, ranked, ScoreKind.SIMILARITY) == [IN_ROOM, FETCH]


def test_what_fits_equally_well_stays_in_order(language):
    for ranked in ([(FETCH, 0.5), (IN_ROOM, 0.5)], [(IN_ROOM, 0.5), (FETCH, 0.5)]):
        forms = [form for form, _ in ranked]
        assert order(language, ranked, ScoreKind.SIMILARITY, "do something") == sorted(
            forms, key=[FETCH, IN_ROOM].index
        )


@pytest.mark.parametrize(
    ("kind", "first", "second", "is_equal"),
    [
        (ScoreKind.PROBABILITY, 0.405, 0.4, True),
        (ScoreKind.PROBABILITY, 0.5, 0.4, False),
        (ScoreKind.LOG_PROBABILITY, -0.700, -0.705, True),
        (ScoreKind.LOG_PROBABILITY, -0.2, -0.9, False),
        (None, 0.0, 0.0, True),
        (None, 0.0, -0.001, False),
    ],
)
def test_a_clearly_better_answer_stays_first(language, kind, first, second, is_equal):
    ranked = [(AT_PLACE, first), (IN_ROOM, second)]
    best = IN_ROOM if is_equal else AT_PLACE
    assert order(language, ranked, kind)[0] == best


def test_groups_do_not_creep(language):
    """Each is close to the next one, the last one is far from the first."""
    ranked = [(AT_PLACE, 0.500), (FETCH, 0.492), (IN_ROOM, 0.484)]
    assert order(language, ranked, ScoreKind.PROBABILITY) == [FETCH, AT_PLACE, IN_ROOM]


def test_unknown_keeps_its_place(language):
    ranked = [("UNKNOWN", 0.5), (AT_PLACE, 0.5), (IN_ROOM, 0.5)]
    assert order(language, ranked, ScoreKind.SIMILARITY) == ["UNKNOWN", IN_ROOM, AT_PLACE]
    ranked = [(AT_PLACE, 0.5), ("UNKNOWN", 0.5), (IN_ROOM, 0.5)]
    assert order(language, ranked, ScoreKind.SIMILARITY) == [AT_PLACE, "UNKNOWN", IN_ROOM]


def test_a_text_that_is_no_form_comes_last(language):
    ranked = [("( bring", 0.5), (AT_PLACE, 0.5)]
    assert order(language, ranked, ScoreKind.SIMILARITY) == [AT_PLACE, "( bring"]


def test_the_writer_orders_alike(language):
    from parser_service.serving.answer_writing import AnswerWriter

    forms = (AT_PLACE, "( bring", IN_CELLAR, FETCH, IN_ROOM)
    candidates = [Candidate(each, 0.5) for each in forms]
    for kind in ("", "similarity", "log_probability"):
        compare(AnswerWriter(language), SAID, candidates, kind)


@pytest.mark.parametrize(
    ("parser", "protocol", "text"),
    [
        ("knn", "strict", SAID),
        ("linear", "domain", SAID),
        ("grammar-oracle", "grammar", "fetch me the hammer from the kitchen table"),
    ],
)
def test_in_the_starter_world_what_can_be_done_comes_first(db, parser, protocol, text):
    split = load_starter_world(lambda sentence: None)[Criterion.COMMAND]
    run = trained_run(split, parser=parser, protocol=protocol, train_sources="gen+para")
    answerer = Shelf(0, Metrics()).load(run.world.name, run.pk)
    best = json.loads(answerer.parse([text], 5)[0])["candidates"][0]
    assert best["open_slots"] == []
    assert best["plan"]["is_executable"]
    assert '"hammer"' in best["grounded"].replace(" ", "")
    assert "kitchen" in best["grounded"]
