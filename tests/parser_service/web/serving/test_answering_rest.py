"""What a world answers over REST: by which part, how sure, and what a robot may do with it."""

from __future__ import annotations

import json

import jsonschema
import pytest

from annotations.exchange.generator_import import import_generator
from annotations.language.forms import SEQUENCE, Application, read_form
from annotations.language.plans import joint_plan_schema
from annotations.models import ApiToken
from parser_service.models import Answering, AnsweringOrder, Promotion
from parser_service.runs.promoting import promote
from parser_service.serving.preparing import MOST_ALTERNATIVES
from parser_service.web.serving.parsing_rest import (
    CandidateSerializer,
    OneAnswerSerializer,
    ParseSerializer,
)
from tests.annotations.conftest import TINY, as_bytes
from tests.parser_service.live_server import parse_server  # noqa: F401  a fixture
from tests.parser_service.made_up import make_split
from tests.parser_service.served import make_home, trained_run

PARSE = "/api/v1/worlds/home/parse/"
TWO = "find the tea. After that, go to the kitchen"


@pytest.fixture
def post(client, annotator):
    """Returns a function that asks REST with a token that may only read."""
    _, key = ApiToken.issue(annotator, "robot", scope="read")

    def send(data, query: str = "", content_type: str = "application/json"):
        headers = {"authorization": f"Bearer {key}"}
        return client.post(f"{PARSE}{query}", data, content_type=content_type, headers=headers)

    return send


@pytest.fixture
def serve(request):
    """Returns a function that lets the parse server answer what the database wants now."""
    shelf = request.getfixturevalue("parse_server")

    def update():
        shelf.update()
        shelf.find("home", None, 0)  # threads do not see what the test has written

    return update


@pytest.fixture
def tiny(world, serve):
    """A world with templates and no run."""
    assert not import_generator(world.name, as_bytes(TINY)).problems
    serve()
    return world


@pytest.fixture
def both(tiny, serve):
    """The same with a learned part."""
    promote(trained_run(make_split(tiny)), None)
    serve()
    return tiny


def ask(post, utterance: str, **asked) -> dict:
    answer = post({"utterance": utterance, **asked})
    assert answer.status_code == 200, answer.content
    return answer.json()


def test_a_world_with_templates_answers_at_once_with_the_fields_of_the_schema(tiny, post):
    answer = ask(post, "find the tea")
    assert set(answer) == set(ParseSerializer().fields)
    assert set(answer["candidates"][0]) == set(CandidateSerializer().fields)
    assert (answer["parser"], answer["run"], answer["agrees"]) == ("grammar-oracle", None, None)
    assert (answer["decision"], answer["is_unknown"]) == ("act", False)
    assert answer["probability"] > 0.9 and "tea" in answer["spoken"]
    assert answer["spoken"] == answer["candidates"][0]["spoken"]
    nothing = {name: answer[name] for name in ("heard", "reasons", "nearest", "several")}
    assert nothing == {"heard": [], "reasons": [], "nearest": [], "several": []}


def test_what_was_heard_otherwise_is_told_with_its_place(tiny, post):
    answer = ask(post, "uhm find the the tea")
    assert [(each["kind"], each["heard"]) for each in answer["heard"]] == [
        *(("filler", ""), ("repeated", "")),
    ]
    for each in answer["heard"]:
        assert answer["utterance"][each["start"] : each["end"]] == each["said"]
    assert answer["decision"] == "act" and answer["utterance"] == "uhm find the the tea"


def test_several_commands_are_one_answer_with_one_plan(tiny, post):
    answer = ask(post, TWO)
    assert [each["utterance"] for each in answer["several"]] == [
        *("find the tea", "go to the kitchen"),
    ]
    assert all(set(OneAnswerSerializer().fields) <= set(each) for each in answer["several"])
    form = read_form(answer["candidates"][0]["form"])
    assert isinstance(form, Application) and form.predicate == SEQUENCE and len(form.arguments) == 2
    jsonschema.validate(answer["joint_plan"], joint_plan_schema())
    assert answer["decision"] == "act" and answer["joint_plan"]["is_executable"]
    # As sure as all of them together.
    one, other = (each["probability"] for each in answer["several"])
    assert answer["probability"] == pytest.approx(one * other, abs=0.001)


def test_a_robot_that_is_unsure_of_one_command_repeats_all_of_them(tiny, post):
    answer = ask(post, "find the tea. go to the kichen")
    decisions = [each["decision"] for each in answer["several"]]
    assert (answer["decision"], decisions) == ("confirm", ["act", "confirm"])
    for each in answer["several"]:
        assert each["candidates"][0]["english"] in answer["spoken"]


def test_words_that_nobody_knows_between_commands_make_a_robot_ask_before_it_acts(tiny, post):
    answer = ask(post, "find the tea. Asdf qwer. go to the kitchen")
    assert [each["decision"] for each in answer["several"]] == ["act", "act"]
    assert answer["decision"] == "confirm"
    assert ask(post, "find the tea. My second wish is: go to the kitchen")["decision"] == "act"


def test_of_more_commands_than_three_a_robot_asks_which(tiny, post):
    answer = post(
        {"utterance": "find the tea. go to the kitchen. find the tea. go to the bath"}
    ).json()
    assert (len(answer["several"]), answer["decision"]) == (4, "ask")
    assert answer["joint_plan"] is None
    assert [each["code"] for each in answer["reasons"]] == ["too_many_commands"]
    assert answer["spoken"] == answer["reasons"][0]["message"]


def test_a_word_that_nobody_knows_is_named_with_commands_that_are_near(tiny, post):
    answer = ask(post, "locate the tea in the flurb")
    assert (answer["decision"], answer["is_unknown"]) == ("refuse", True)
    assert answer["probability"] is None
    assert [each["code"] for each in answer["reasons"]] == ["unknown_word"]
    assert "flurb" in answer["spoken"] and answer["candidates"] == []
    assert ask(post, answer["nearest"][0])["decision"] == "act"


@pytest.mark.parametrize("said", ["Do not find the tea", "Never go to the kitchen"])
def test_a_prohibition_is_refused_without_a_learned_part_too(tiny, post, said):
    answer = ask(post, said)
    assert answer["decision"] == "refuse"
    assert "forbidden" in [each["code"] for each in answer["reasons"]]
    assert answer["nearest"] == []


def test_a_nearest_neighbour_does_not_what_is_forbidden(world, post, serve):
    promote(trained_run(make_home(world)), None)
    serve()
    answer = ask(post, "Do not bring me the red cup")
    assert (answer["parser"], answer["decision"], answer["is_unknown"]) == ("knn", "refuse", True)
    assert [each["code"] for each in answer["reasons"]] == ["forbidden"]
    # Without people's utterances to calibrate on, what a learned parser says is confirmed at most.
    assert ask(post, "bring me the red cup")["decision"] == "confirm"


def test_the_best_alternative_that_is_understood_is_answered(tiny, post):
    offered = [("sing a song", -0.1), ("find the milk", -0.9), ("find the tea", -2.0)]
    heard = [{"utterance": text, "score": score} for text, score in offered]
    answer = post({"alternatives": heard})
    assert answer.json()["utterance"] == "find the milk"
    nothing = post({"alternatives": [{"utterance": "sing a song"}, {"utterance": "dance"}]}).json()
    assert (nothing["utterance"], nothing["decision"]) == ("sing a song", "refuse")


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"utterance": " "},
        {"utterance": "find the tea", "alternatives": [{"utterance": "find the tea"}]},
        {"alternatives": [{"utterance": "find the tea"}] * (MOST_ALTERNATIVES + 1)},
        {"alternatives": [{"score": 1.0}]},
        {"utterance": "find the tea", "parser": "knn"},
        {"utterance": "find the tea", "parser": "grammar-oracle", "run": 1},
    ],
)
def test_what_is_no_question_to_the_world_is_refused(tiny, post, body):
    assert post(body).status_code == 400


def test_the_oracle_answers_first_and_the_learned_part_where_it_is_silent(both, post):
    assert ask(post, "find the tea")["parser"] == "grammar-oracle"
    learned = ask(post, "where is the tea now")
    assert learned["parser"] == "knn" and learned["run"] is not None
    alone = ask(post, "where is the tea now", parser="grammar-oracle")
    assert (alone["parser"], alone["decision"]) == ("grammar-oracle", "refuse")


def test_lines_are_answered_by_the_same_parts(both, post):
    said = ["find the tea", "where is the tea now", TWO]
    lines = "".join(json.dumps({"utterance": each}) + "\n" for each in said)

    def answers(query: str = "") -> list[dict]:
        answer = post(lines, query, "application/jsonl")
        return [json.loads(line) for line in b"".join(answer.streaming_content).splitlines()]

    assert answers() == [ask(post, each) for each in said]
    alone = answers("?parser=grammar-oracle")
    assert [each["parser"] for each in alone] == ["grammar-oracle"] * 3
    assert [each["decision"] for each in alone] == ["act", "refuse", "act"]
    assert [len(each["several"]) for each in alone] == [0, 0, 2]
    assert post(lines, "?parser=knn", "application/jsonl").status_code == 400


@pytest.mark.parametrize(
    ("order", "parser", "to_people"),
    [
        (AnsweringOrder.BOTH, "grammar-oracle", "knn"),
        (AnsweringOrder.ORACLE, "grammar-oracle", "grammar-oracle"),
        (AnsweringOrder.LEARNED, "knn", "knn"),
    ],
)
def test_the_order_of_the_world_says_who_answers(both, post, serve, order, parser, to_people):
    Answering.objects.create(world=both, order=order)
    serve()
    assert ask(post, "find the tea")["parser"] == parser
    assert ask(post, "where is the tea now")["parser"] == to_people


def test_an_oracle_that_an_older_version_promoted_is_the_one_of_today(tiny, post, serve):
    run = trained_run(make_split(tiny), parser="grammar-oracle", protocol="grammar", spoken=None)
    Promotion.objects.create(world=tiny, run=run, state="promoted")
    serve()
    answer = ask(post, "find the tea")
    assert (answer["parser"], answer["run"], answer["decision"]) == ("grammar-oracle", None, "act")


def test_of_several_commands_what_is_not_understood_is_handed_on(tiny, post):
    answer = ask(post, "find the tea, asdf the qwer and go to the kitchen")
    assert (answer["decision"], answer["is_unknown"]) == ("ask", True)
    joint = answer["joint_plan"]
    jsonschema.validate(joint, joint_plan_schema())
    assert joint["steps"] and not joint["is_executable"]
    (waiting,) = joint["unresolved"]
    assert (waiting["commands"], waiting["steps"]) == ([2], [])
    (word,) = waiting["open"][0]["words"]
    assert word["text"] == answer["several"][1]["utterance"] == "asdf the qwer"


def test_what_has_a_condition_is_not_cut_to_what_is_understood(both, post):
    answer = ask(post, "find the tea. If it rains, go to the kitchen")
    assert answer["decision"] == "refuse" and not answer["several"]
