"""What a robot hears in the starter world: over REST, from parsers that were made of what is there."""

from __future__ import annotations

import jsonschema
import pytest
from django.utils import timezone

from annotations.exchange.starter_world import STARTER_WORLD, load_starter_world
from annotations.language.corpus import Criterion
from annotations.language.plans import plan_schema
from annotations.models import User
from parser_service.models import Promotion, PromotionState
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import Shelf
from tests.conftest import member
from tests.parser_service.served import trained_run

WORLD = f"/api/v1/worlds/{STARTER_WORLD}"
# One that knows the grammar, and one that learned from pairs and knows no entity.
ORACLE, NEIGHBOURS = ("grammar-oracle", "grammar"), ("knn", "strict")


@pytest.fixture
def shelf(db, request):
    """A parser of the split by command that answers in the starter world."""
    parser, protocol = request.param
    split = load_starter_world(lambda sentence: None)[Criterion.COMMAND]
    run = trained_run(split, parser=parser, protocol=protocol, train_sources="gen+para")
    # An older version promoted runs of the oracle too.
    Promotion.objects.create(
        world=split.world, run=run, state=PromotionState.PROMOTED, decided_at=timezone.now()
    )
    member(split.world, "anna", "annotator")
    made = Shelf(10_000_000, Metrics())
    made.update()
    return made


@pytest.fixture
def ask(parse_server, call):
    """Returns a function that asks REST in the name of an annotator."""
    anna = User.objects.get(username="anna")
    return lambda path, data=None: call(anna, f"{WORLD}/{path}", data).json()


@pytest.mark.parametrize("shelf", [ORACLE], indirect=True)
def test_a_command_gets_a_form_and_a_plan_and_two_clear_places_need_no_question(ask):
    said = {"utterance": "get me the apple juice from the kitchen table"}
    best = ask("parse/", said)["candidates"][0]
    assert best["grounded"] == (
        '( bring ( lambda $1 e ( is_a $1 " apple juice " ) ( at $1 " kitchen table " ) ) )'
    )
    assert best["open_slots"] == []
    jsonschema.validate(best["plan"], plan_schema())
    assert best["plan"]["is_executable"]

    said = {"utterance": "move the honey from the worktop to the kitchen table"}
    moved = ask("dialogues/", said)
    assert (moved["phase"], moved["asked"]) == ("confirming", None)
    assert '"honey"' in moved["grounded"].replace(" ", "")


@pytest.mark.parametrize("shelf", [NEIGHBOURS], indirect=True)
def test_things_joined_with_or_are_asked_about_and_an_unknown_one_once(ask, parse_server):
    row = ask("dialogues/", {"utterance": "bring me the honey or the lemonade"})
    assert row["prompt"].endswith("? Honey or lemonade?")
    assert row["asked"]["choices"] == ["honey", "lemonade"]
    assert not row["plan"]["is_executable"]
    after = ask(f"dialogues/{row['id']}/answer/", {"answer": "the lemonade"})
    assert after["prompt"] == "Shall I bring you the lemonade?" and after["offers"] == []

    row = ask("dialogues/", {"utterance": "bring me the flurb"})
    assert row["prompt"].startswith("Which object do you mean by “flurb”?")
    after = ask(f"dialogues/{row['id']}/answer/", {"answer": "new"})
    assert after["prompt"] == "Shall I bring you the flurb?"
    (offer,) = ask("offered-entities/")["results"]
    assert ask(f"offered-entities/{offer['id']}/decide/", {"decision": "confirm"})
    parse_server.update()
    again = ask("dialogues/", {"utterance": "bring me the flurb"})
    assert (again["phase"], again["asked"]) == ("confirming", None)
    assert again["plan"]["is_executable"]


@pytest.mark.parametrize("shelf", [NEIGHBOURS], indirect=True)
def test_of_equally_good_readings_the_dialogue_takes_the_one_that_leaves_nothing_open(ask):
    said = {"utterance": "bring me the hammer from the kitchen"}
    row = ask("dialogues/", said)
    assert (row["phase"], row["asked"]) == ("confirming", None)
    assert row["grounded"] == ask("parse/", said)["candidates"][0]["grounded"]
