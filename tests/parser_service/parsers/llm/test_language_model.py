"""The parser that asks a language model: what it asks, and what it makes of the answers."""

from __future__ import annotations

import json

import pytest

from annotations.language.forms import read_form
from annotations.language.texts.errors import Refusal
from annotations.language.world import (
    Entity,
    Ontology,
    Predicate,
    PredicateKind,
    infer_signatures,
    read_signatures,
)
from parser_service.parsers.interface import TRAINING, Cancelled, Knowledge, Observer, Pair
from parser_service.parsers.knn import NearestNeighbour
from parser_service.parsers.llm.config import LanguageModelConfig
from parser_service.parsers.llm.language_model import LanguageModel
from tests.parser_service.llm_server import KEY, MODEL, REPORTED, says
from tests.parser_service.made_up import made_up_pairs

PAIRS = [Pair(command, form) for command, _, form in made_up_pairs()]
GO, FIND, FOLLOW = '( go " <room> " )', "( find ( lambda $1 e ( person $1 ) ) )", "( follow them )"
COMPOSED = [
    Pair("go to the <room> and find somebody", f"( sequence {GO} {FIND} )"),
    Pair("find somebody and follow them", f"( sequence {FIND} {FOLLOW} )"),
    Pair("go to the <room>", GO),
]
BRING = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
POINT = '( point ( lambda $1 e ( is_a $1 " <object> " ) ) )'


def fitted(pairs=PAIRS, knowledge=None, **config) -> LanguageModel:
    parser = LanguageModel(LanguageModelConfig(model=MODEL, **config), 3, knowledge)
    parser.fit(pairs)
    return parser


def forms(parser, *utterances) -> list[str]:
    return ["|".join(each.form for each in ranked) for ranked in parser.predict(utterances, 5)]


def enum_of(asked) -> list[str]:
    schema = asked["response_format"]["json_schema"]["schema"]
    return schema["properties"]["form"]["enum"]


def test_the_question_has_the_nearest_pairs_as_turns_and_their_forms_as_a_schema(place, tiny):
    parser = fitted(examples=3, forms=4)
    parser.predict(["bring me the object please"])
    asked = tiny.asked[-1]
    assert asked["path"] == "/v1/chat/completions"
    assert (asked["model"], asked["temperature"], asked["seed"], asked["stream"]) == (
        MODEL,
        0,
        3,
        False,
    )
    roles = [each["role"] for each in asked["messages"]]
    assert roles == ["system", *3 * ["user", "assistant"], "user"]
    assert asked["messages"][-1]["content"] == "bring me the object please"

    knn = NearestNeighbour()
    knn.fit(PAIRS)
    nearest = [each.form for each in knn.predict(["bring me the object please"], 4)[0]]
    last = json.loads(asked["messages"][-2]["content"])
    assert last["form"] == nearest[0]
    assert len(enum_of(asked)) == 5 and enum_of(asked)[-1] == "UNKNOWN"
    assert enum_of(asked)[0] == nearest[0]
    assert asked["response_format"]["json_schema"]["strict"] is True
    system = asked["messages"][0]["content"]
    assert all(form in system for form in enum_of(asked))


def test_predicates_and_glosses_are_told_under_domain_alone(place, tiny):
    signatures = read_signatures("(lambda)")
    told = {
        "bring": Predicate("bring", PredicateKind.ACTION, signatures, "fetch it, quickly"),
        "unheard": Predicate("unheard", PredicateKind.ACTION, signatures),
    }
    fitted().predict(["bring me the object now"])
    fitted(knowledge=Knowledge(predicates=told)).predict(["bring me the object now"])
    told_of = {each["messages"][-1]["content"]: [] for each in tiny.asked}
    for each in tiny.asked:
        told_of[each["messages"][-1]["content"]].append(each["messages"][0]["content"])
    strict, domain = told_of["bring me the object now"]
    assert "fetch it, quickly" not in strict and "means:" not in strict
    assert "bring (" in domain and ": fetch it, quickly" in domain
    assert domain.index("bring (") < domain.index("unheard (")
    assert f"{BRING}  means: fetch it, quickly" in domain


@pytest.mark.parametrize(
    ("text", "form"),
    [
        (json.dumps({"form": BRING}), BRING),
        (f"```json\n{json.dumps({'form': BRING})}\n```", BRING),
        (f"<think>Is it {POINT}?</think>\n{BRING}", BRING),
        (BRING.replace("$1", "$7").replace("( ", "("), BRING),
        (json.dumps({"form": "UNKNOWN"}), "UNKNOWN"),
        (json.dumps({"form": POINT}), ""),
        (json.dumps({"other": BRING}), ""),
        ("I would rather not.", ""),
        ("", ""),
    ],
)
def test_a_listed_answer_is_one_of_the_list_or_none(place, tiny, text, form):
    parser = fitted()
    tiny.always = says(text)
    assert forms(parser, "bring me that object") == [form]


@pytest.mark.parametrize(
    ("text", "form", "origin"),
    [
        (BRING, BRING, TRAINING),
        (f"```\n{POINT}\n```", POINT, "written"),
        ("UNKNOWN", "UNKNOWN", ""),
        ("bring it", "bring it", "written"),
    ],
)
def test_a_free_answer_is_read_as_a_form(place, tiny, text, form, origin):
    parser = fitted(decoding="free")
    tiny.always = says(text)
    [[answer]] = parser.predict(["bring me that object"], 5)
    assert (answer.form, answer.origin, answer.score) == (form, origin, 0)
    assert "response_format" not in tiny.asked[-1]
    assert tiny.asked[-1]["messages"][-2]["content"].startswith("( ")


def test_where_commands_are_composed_the_list_is_one_of_actions(place, tiny):
    parser = fitted(COMPOSED)
    parser.predict(["go to the <room> now"])
    asked = tiny.asked[-1]
    actions = asked["response_format"]["json_schema"]["schema"]["properties"]["actions"]
    assert set(actions["items"]["enum"]) == {GO, FIND, FOLLOW, "UNKNOWN"}
    assert (actions["minItems"], actions["maxItems"]) == (1, 2)
    system, *_, last, _ = (each["content"] for each in asked["messages"])
    assert "( sequence" in system and "them" in system
    assert json.loads(last) == {"actions": [GO]}
    single = tiny.asked[0]["messages"][0]["content"]
    fitted()
    assert "sequence" not in tiny.asked[-1]["messages"][0]["content"] and single == system


@pytest.mark.parametrize(
    ("text", "form", "origin"),
    [
        (json.dumps({"actions": [GO, FIND]}), f"( sequence {GO} {FIND} )", TRAINING),
        (f"```json\n{json.dumps({'actions': [GO]})}\n```", GO, TRAINING),
        (f"( sequence {FIND} {FOLLOW} )", f"( sequence {FIND} {FOLLOW} )", TRAINING),
        (json.dumps({"actions": [FIND, GO]}), f"( sequence {FIND} {GO} )", "composed"),
        # What the list does not have, and what nothing stands for, stays open.
        (json.dumps({"actions": [GO, POINT]}), f"( sequence {GO} UNKNOWN )", "written"),
        (json.dumps({"actions": [GO, "UNKNOWN"]}), f"( sequence {GO} UNKNOWN )", "written"),
        (json.dumps({"actions": [GO, FOLLOW]}), f"( sequence {GO} ( follow UNKNOWN ) )", "written"),
        (json.dumps({"actions": ["UNKNOWN"]}), "UNKNOWN", ""),
    ],
)
def test_actions_are_put_together_in_their_order(place, tiny, text, form, origin):
    parser = fitted(COMPOSED)
    tiny.always = says(text)
    [[answer]] = parser.predict(["go to the <room> then"], 5)
    assert (answer.form, answer.origin) == (form, origin)


@pytest.mark.parametrize(
    "answer", [{"actions": [POINT]}, {"actions": []}, {"actions": [GO, GO, GO]}, {"actions": GO}]
)
def test_more_actions_than_any_form_has_or_none_of_the_list_are_no_answer(place, tiny, answer):
    parser = fitted(COMPOSED)
    tiny.always = says(json.dumps(answer))
    assert parser.predict(["go to the <room> then"]) == [[]]


@pytest.mark.parametrize("decoding", ["listed", "free"])
def test_in_the_domain_an_answer_holds_what_the_world_has(place, tiny, decoding):
    ontology = Ontology((Entity("room", "kitchen"), Entity("room", "study")))
    predicates = infer_signatures(read_form(pair.form) for pair in COMPOSED)
    parser = fitted(COMPOSED, Knowledge(predicates, ontology), decoding=decoding)
    tiny.always = says('( sequence ( go " kitchn " ) ( point " kitchen " ) )\nuser: go')
    [[answer]] = parser.predict(["go to the kitchen and dance"])
    if decoding == "free":
        assert (answer.form, answer.values) == (f"( sequence {GO} UNKNOWN )", ("kitchen",))
    tiny.always = says(f'( sequence ( go " kitchn " ) {FIND} )')
    [[answer]] = parser.predict(["go to the kitchen and find one"])
    assert (answer.form, answer.values) == (f"( sequence {GO} {FIND} )", ("kitchen",))


def test_an_answer_holds_nothing_that_a_database_refuses(place, tiny):
    parser = fitted(decoding="free")
    tiny.reports = "tiny\0\ud800"
    tiny.always = says("bring\0 \ud800" + 5000 * "x")
    [[answer]] = parser.predict(["bring me that object"])
    assert "\0" not in answer.form and len(answer.form) <= 2000
    answer.form.encode(), parser.answered_by.encode()


def test_it_names_the_model_as_the_server_reports_it(place, tiny):
    parser = fitted()
    assert parser.answered_by == REPORTED
    tiny.reports = None
    parser.predict(["find a chair"])
    assert parser.answered_by == f"{REPORTED}, {MODEL}"


def test_equal_pairs_in_another_order_ask_the_same(place, tiny):
    fitted().predict(["find my object in the <room>"])
    count = len(tiny.asked)
    fitted(PAIRS[::-1]).predict(["find my object in the <room>"])
    assert [each for each in tiny.asked[count:] if "find my object" in str(each)] == []


def test_a_saved_parser_answers_the_same_and_holds_neither_key_nor_address(place, tiny, tmp_path):
    parser = fitted()
    parser.save(tmp_path / "saved")
    loaded = LanguageModel.load(tmp_path / "saved")
    assert (loaded.config, loaded.seed) == (parser.config, 3)
    asked = ["go get my object", "find a category"]
    assert loaded.predict(asked) == parser.predict(asked)
    for path in (tmp_path / "saved").iterdir():
        assert KEY not in path.read_text() and tiny.url not in path.read_text()
    pairs = tmp_path / "saved" / "pairs.json"
    pairs.write_text(pairs.read_text() + " ")
    with pytest.raises(Refusal) as refused:
        LanguageModel.load(tmp_path / "saved")
    assert refused.value.code == "saved_file_altered"


@pytest.mark.parametrize(
    ("pairs", "model", "code"),
    [([], MODEL, "no_training_pairs"), (PAIRS, "", "hyperparameter_missing")],
)
def test_what_cannot_be_trained_is_refused(place, pairs, model, code):
    with pytest.raises(Refusal) as refused:
        LanguageModel(LanguageModelConfig(model=model)).fit(pairs)
    assert refused.value.code == code


def test_a_model_that_the_server_does_not_have_is_refused_with_those_it_has(place, tiny):
    tiny.models = ["large", "small:latest"]
    with pytest.raises(Refusal, match=r"'tiny'.*: large, small:latest") as refused:
        fitted()
    assert refused.value.code == "language_model_refused"
    assert tiny.asked == []
    tiny.models = ["tiny:latest"]
    fitted()
    tiny.models = None  # a server without a list
    fitted([*PAIRS, Pair("wave", POINT)])


def test_training_tells_the_log_what_answers_and_hears_that_it_is_to_stop(place):
    class Watching(Observer):
        def __init__(self):
            self.lines = []

        def log(self, message):
            self.lines.append(message)

    watching = Watching()
    parser = LanguageModel(LanguageModelConfig(model=MODEL))
    parser.fit(PAIRS, PAIRS[:1], watching)
    assert f"answers with {REPORTED}, the first time in" in watching.lines[-1]

    class Stopping(Observer):
        def check(self):
            raise Cancelled

    with pytest.raises(Cancelled):
        LanguageModel(LanguageModelConfig(model=MODEL)).fit(PAIRS, observe=Stopping())
