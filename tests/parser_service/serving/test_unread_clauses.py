"""A learned part that does not read what is said last says so, and is less sure."""

from __future__ import annotations

import json

import pytest

from parser_service.runs.promoting import promote
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf
from tests.parser_service.served import make_home, trained_run


@pytest.fixture
def ask(world):
    promote(trained_run(make_home(world), parser="linear", protocol="domain"), None)
    shelf = Shelf(10_000_000, Metrics())
    shelf.update()
    answerer = shelf.find(world.name, None, 0)
    return lambda utterance: json.loads(answerer.parse([utterance], 5)[0])


@pytest.mark.parametrize("clause", ["and polish it", "then wax it", "and yodel"])
def test_a_clause_that_changes_nothing_is_left_out(ask, clause):
    plain, more = ask("please fetch the bowl"), ask(f"please fetch the bowl {clause}")
    assert not plain["reasons"] and not more["is_unknown"]
    assert more["candidates"][0]["form"] == plain["candidates"][0]["form"]
    assert [each["code"] for each in more["reasons"]] == ["left_out"]
    assert clause.partition(" ")[2] in more["reasons"][0]["message"]
    assert more["probability"] < plain["probability"] and more["decision"] != "act"


@pytest.mark.parametrize("closing", ["and that is all", "and thank you", "and bring me it", ""])
def test_what_asks_for_nothing_more_leaves_nothing_out(ask, closing):
    assert not ask(f"please fetch the bowl {closing}")["reasons"]
