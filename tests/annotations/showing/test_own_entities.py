"""A form is said with the entities of the utterance that it is for."""

from __future__ import annotations

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from annotations.labelling.collecting import collect
from annotations.models import Entity, Example, Paraphrase, Utterance
from annotations.showing.own_entities import OwnEntities

IS_A = '( lambda $1 e ( is_a $1 " <object> " ) )'
FIND = f"( find {IS_A} )"
TWO_PLACES = '( find ( lambda $1 e ( at $1 " <room> " " <location> " ) ) )'


@pytest.fixture
def own(tiny_world):
    Entity.objects.filter(text="drinks").update(attributes={"singular": "drink"})
    collect(tiny_world, ["look for the tea", "go to the kitchen", "fetch a drink", "find it"])
    rows = {row.text: row for row in Utterance.objects.select_related("world")}
    return lambda text: OwnEntities.of_utterance(rows[text])


def test_a_candidate_is_said_with_what_the_utterance_names(own):
    assert own("look for the tea").english(FIND) == "find the tea"
    assert own("go to the kitchen").english('( go " <room> " )') == "go to the kitchen"


def test_what_the_utterance_does_not_name_is_said_by_its_class(own):
    assert own("find it").english(FIND) == "find the object"
    assert own("look for the tea").english('( go " <room> " )') == "go to the room"


def test_any_object_of_a_category_is_said_in_the_words_of_the_utterance(own):
    assert own("fetch a drink").english(FIND) == "find the drink"


def test_what_is_no_form_has_no_sentence(own):
    assert own("find it").english("( find") == ""


def test_many_candidates_cost_no_more_statements_than_one(own, tiny_world):
    said = own("look for the tea")
    said.english(FIND)
    with CaptureQueriesContext(connection) as asked:
        for _ in range(9):
            said.english(FIND)
    assert len(asked) == 0


PAIR = {
    "logical_form": f'( put {IS_A} " <location> " )',
    "grounded_form": '( put ( lambda $1 e ( is_a $1 " tea " ) ) " sink " )',
    "utterance": "could the tea go into the basin",
}


@pytest.mark.parametrize("model", [Example, Paraphrase])
def test_an_answer_to_a_pair_has_the_entities_of_its_form(world, model):
    own = OwnEntities.of_pair(world, model(**PAIR))
    assert "tea" in own.english(PAIR["logical_form"])
    assert "sink" in own.english(PAIR["logical_form"])
    assert own.english(FIND) == "find the tea"
    assert own.english('( go " <location> " )').endswith("the sink")


def test_of_two_names_the_one_is_taken_that_the_text_says_there(world):
    label = (
        '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <location> " ) ) " <location> " )'
    )
    grounded = '( bring ( lambda $1 e ( is_a $1 " tea " ) ( at $1 " sink " ) ) " desk " )'
    row = Example(
        logical_form=label,
        grounded_form=grounded,
        utterance="bring the tea from the sink to the desk",
    )
    own = OwnEntities.of_pair(world, row)
    assert own.english('( go " <location> " )') == "go to the desk"


def test_a_pair_without_entities_is_said_as_it_is(world):
    row = Example(logical_form=FIND, grounded_form="", utterance="hunt for the <object>")
    assert OwnEntities.of_pair(world, row).english(FIND) == "find the object"


def test_a_text_that_somebody_tries_is_read_with_the_whole_world(tiny_world):
    assert OwnEntities.in_text(tiny_world, "where is the milk").english(FIND) == "find the milk"
