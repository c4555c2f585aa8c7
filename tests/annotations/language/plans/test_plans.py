from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema
import pytest
from defusedxml.ElementTree import fromstring
from hypothesis import given

from annotations.language.forms import read_form
from annotations.language.grounding import Anonymizer, deanonymize
from annotations.language.plans import (
    ASK,
    ActionName,
    Described,
    Plan,
    Robust,
    Trouble,
    make_plan,
    plan_schema,
    to_behavior_tree,
)
from annotations.language.world import Entity, Ontology
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.plans.xml_schema import xml_schema
from tests.annotations.language.published import SHARED, needs_corpus
from tests.annotations.language.random_forms import forms
from tests.annotations.language.sample_ontology import HOME

STARTER = Path(__file__).parents[4] / "annotations" / "starter" / "household"
JSON_SCHEMA = jsonschema.Draft202012Validator(plan_schema())


def plan_of(text: str, **options: Any) -> Plan:
    """Return the plan of a form; what it is written as follows its schemas."""
    plan = make_plan(read_form(text), HOME, **options)
    require_valid(plan)
    return plan


def require_valid(plan: Plan) -> None:
    JSON_SCHEMA.validate(plan.as_json())
    xml_schema().validate(to_behavior_tree(plan))
    xml_schema().validate(to_behavior_tree(plan, Robust()))


def troubles(plan: Plan) -> list[str]:
    return [str(problem.trouble) for problem in plan.problems]


def test_an_action_has_named_arguments_with_the_entities_of_the_ontology() -> None:
    plan = plan_of('(bring (λ$1:e (is_a $1 "tea") (at $1 "stool")))')
    assert plan.is_executable
    assert [step.as_json() for step in plan.steps] == [
        {
            "number": 1,
            "action": "bring",
            "predicate": "bring",
            "text": "bring me the tea that is at the stool",
            "arguments": {
                "thing": {
                    "kind": "description",
                    "id": "x1",
                    "text": "the tea that is at the stool",
                    "conditions": [
                        {
                            "predicate": "is_a",
                            "values": [entity("object", "tea", category="drinks")],
                        },
                        {"predicate": "at", "values": [entity("location", "stool", room="attic")]},
                    ],
                }
            },
            "gives_result": False,
        }
    ]


def entity(entity_class: str, text: str, **attributes: str) -> dict[str, Any]:
    return {
        "kind": "entity",
        "entity_class": entity_class,
        "text": text,
        "attributes": attributes,
    }


def test_a_place_that_two_rooms_have_has_no_room() -> None:
    place = plan_of('(go "shelf")').steps[0].arguments
    assert [(name, value.as_json()) for name, value in place] == [
        ("destination", entity("location", "shelf"))
    ]


def test_a_sequence_becomes_steps_and_a_shared_variable_stays_the_same_person() -> None:
    plan = plan_of(
        '(λ$1:e (sequence (follow (person $1) (name $1 "Ada") (at $1 "stool")) (guide $1 "current")))'
    )
    follow, guide = plan.steps
    assert (follow.predicate, guide.predicate) == ("follow", "guide")
    assert dict(follow.arguments)["person"] == dict(guide.arguments)["person"]
    assert dict(guide.arguments)["destination"].as_json() == {"kind": "text", "text": "current"}
    assert plan.is_executable


def test_what_an_action_says_about_a_count_is_a_step_before_it() -> None:
    plan = plan_of('(say (count (λ$1:e (person $1) (at $1 "attic"))))')
    assert [(step.predicate, step.gives_result) for step in plan.steps] == [
        ("count", True),
        ("say", False),
    ]
    assert dict(plan.steps[1].arguments)["text"].as_json() == {"kind": "result", "step": 1}
    assert 'text="{result_1}"' in to_behavior_tree(plan)


def test_things_beside_things_and_attributes_of_people_are_nested() -> None:
    nested = '(bring (λ$1:e (λ$2:e (is_a $2 "tea") (right_of $1 $2))))'
    direct = '(bring (λ$1:e (right_of $1 (λ$1:e (is_a $1 "tea")))))'
    for text in (nested, direct):
        thing = dict(plan_of(text).steps[0].arguments)["thing"].as_json()
        (beside,) = thing["conditions"]
        assert beside["predicate"] == "right_of"
        assert beside["values"][0]["conditions"][0]["predicate"] == "is_a"
    asked = plan_of('(say (λ$1:e (λ$2:e (person $2) (name $2 $1) (at $2 "attic"))))')
    about = dict(asked.steps[0].arguments)["about"].as_json()
    assert (about["kind"], about["attribute"]) == ("attribute", "name")
    assert [each["predicate"] for each in about["of"]["conditions"]] == ["person", "at"]


def test_unknown_asks_the_operator() -> None:
    plan = plan_of("UNKNOWN")
    assert [step.predicate for step in plan.steps] == [ASK]
    assert troubles(plan) == [Trouble.NOT_UNDERSTOOD]
    assert not plan.is_executable


@pytest.mark.parametrize(
    ("text", "message", "question"),
    [
        (
            '(guide (λ$1:e (person $1) (name $1 "Ada")) UNKNOWN)',
            "Nothing says the destination of “guide”.",
            "Where shall I guide Ada?",
        ),
        (
            '(guide (λ$1:e (person $1) (name $1 "Ada")))',
            "Nothing says the destination of “guide”.",
            "Where shall I guide Ada?",
        ),
        ("(go UNKNOWN)", "Nothing says the destination of “go”.", "Where shall I go?"),
        ("(go)", "Nothing says the destination of “go”.", "Where shall I go?"),
        (
            '(put (λ$1:e (is_a $1 "tea")) UNKNOWN)',
            "Nothing says the destination of “put”.",
            "Where shall I put the tea?",
        ),
        ("(bring UNKNOWN)", "Nothing says the thing of “bring”.", "What shall I bring you?"),
    ],
)
def test_a_missing_argument_is_named_and_asked_for_before_the_action(
    text: str, message: str, question: str
) -> None:
    plan = plan_of(text)
    ask, action = plan.steps
    assert dict(ask.arguments)["question"].as_json()["text"] == question
    assert {"kind": "result", "step": 1} in [value.as_json() for _, value in action.arguments]
    assert [(each.message, each.step) for each in plan.problems] == [(message, 2)]


def test_a_class_token_is_asked_for() -> None:
    plan = plan_of('(bring (λ$1:e (is_a $1 "<object>")))')
    assert [step.predicate for step in plan.steps] == [ASK, "bring"]
    assert troubles(plan) == [Trouble.OPEN_SLOT]


@pytest.mark.parametrize(
    ("text", "questions"),
    [
        (
            '(put (λ$1:e (is_a $1 "<object>") (at $1 "<location>")) "<location>")',
            ["What shall I put?", "Where is it?", "Where shall I put it?"],
        ),
        (
            '(put (λ$1:e (is_a $1 "tea") (at $1 "<location>")) "<location>")',
            ["Where is the tea?", "Where shall I put the tea?"],
        ),
        (
            '(say (count (λ$1:e (is_a $1 "<category>") (at $1 "attic"))))',
            ["Which kind of thing in the attic shall I count?"],
        ),
        (
            '(sequence (bring (λ$1:e (is_a $1 "<object>"))) (go "<room>"))',
            ["What shall I bring you?", "Which room shall I go to?"],
        ),
        (
            '(λ$1:e (sequence (follow (person $1) (name $1 "<name>")) (guide $1 "<room>")))',
            ["Who shall I follow?", "Which room shall I guide them to?"],
        ),
    ],
)
def test_a_plan_asks_as_a_person_would(text: str, questions: list[str]) -> None:
    asked = [step for step in plan_of(text).steps if step.predicate == ASK]
    assert [dict(step.arguments)["question"].as_json()["text"] for step in asked] == questions


def test_an_entity_that_the_ontology_does_not_have_is_named() -> None:
    plan = plan_of('(bring (λ$1:e (is_a $1 "flurb")))')
    assert [each.message for each in plan.problems] == ["The ontology has no “flurb”."]
    assert troubles(plan_of('(go "moon")')) == [Trouble.UNKNOWN_ENTITY]
    for known in ("TEA", "cuppa", "drink", "drinks", "objects"):
        assert plan_of(f'(bring (λ$1:e (is_a $1 "{known}")))').is_executable, known


@pytest.mark.parametrize(
    ("locations", "meant", "question"),
    [
        (["sofa", "garbage pail"], "garbage pail", None),
        (["cabinet", "Trash Bin"], "Trash Bin", None),
        (["sink", "trash"], "trash", None),
        (["cabin", "binder shelf"], None, None),
        (["garbage bin", "trash bin", "sofa"], "trash bin", None),
        (["trashcan", "waste basket"], "trashcan", None),
        (["trash bin", "kitchen trash can"], None, "the trash bin or the kitchen trash can"),
        (["waste basket", "sofa", "dustbin"], None, "the waste basket or the dustbin"),
    ],
)
def test_the_trash_is_the_place_with_a_word_for_it_in_its_name(
    locations: list[str], meant: str | None, question: str | None
) -> None:
    rooms = ({"room": "kitchen"}, {"room": "hall"}, {"room": "attic"})
    rows = (Entity("location", *each) for each in zip(locations, [()] * 3, rooms, strict=False))
    plan = make_plan(
        read_form('(sequence (take (λ$1:e (largest $1 2))) (put it "trash"))'),
        Ontology(tuple(rows)),
    )
    require_valid(plan)
    destination = said_in(plan, -1, "destination")
    asked = [
        dict(step.arguments)["question"].as_json()["text"]
        for step in plan.steps
        if step.predicate == ASK
    ]
    assert asked == [f"Which one do you mean: {question}?"] * (question is not None)
    if meant:
        room = rooms[locations.index(meant)]["room"]
        assert destination == entity("location", meant, room=room)
    else:
        assert (Trouble.AMBIGUOUS if question else Trouble.UNKNOWN_ENTITY) in troubles(plan)


def test_a_superlative_needs_a_set() -> None:
    assert troubles(plan_of("(bring (λ$1:e (largest $1)))")) == [Trouble.SUPERLATIVE_WITHOUT_SET]
    for text in (
        '(bring (λ$1:e (largest $1) (is_a $1 "drinks")))',
        '(bring (λ$1:e (largest $1)) "stool")',
        '(bring (λ$1:e (leftmost $1 "stool")))',
        '(say (λ$1:e (and (largest $1) (at $1 "stool"))))',
    ):
        assert plan_of(text).is_executable, text


def test_a_description_alone_is_nothing_to_do() -> None:
    plan = plan_of('(λ$1:e (is_a $1 "tea") (at $1 "stool"))')
    assert [(each.trouble, each.step) for each in plan.problems] == [(Trouble.NO_ACTION, 0)]
    assert [each.predicate for each in plan.steps] == [ASK]
    assert said_in(plan, 0, "expects")["text"] == "command"


def test_a_likely_entity_is_to_be_confirmed() -> None:
    form = read_form('(put (λ$1:e (is_a $1 "<object>") (at $1 "<location>")) "<location>")')
    heard = Anonymizer(HOME).anonymize("grab the tea on the stool and put it on the shelf")
    given = deanonymize(form, heard, HOME)
    plan = make_plan(given.form, HOME, slots=given.slots)
    require_valid(plan)
    assert troubles(plan) == [Trouble.AMBIGUOUS] * 2
    assert plan.problems[0].message == "It is not certain that the location is “stool”."


def test_actions_and_arguments_have_the_names_of_the_robot() -> None:
    names = {
        "go": ActionName("NavigateTo", {"destination": "goal"}),
        ASK: ActionName("Ask", {"question": "prompt"}),
    }
    ask, go = plan_of("(go UNKNOWN)", action_names=names).steps
    assert (ask.action, [name for name, _ in ask.arguments]) == ("Ask", ["prompt", "expects"])
    assert (go.action, [name for name, _ in go.arguments]) == ("NavigateTo", ["goal"])


def test_the_behaviour_tree_has_ports_that_the_library_takes() -> None:
    plan = make_plan(read_form('(say "{x} <b> & c" (λ$1:e (name $1 "Ada")) )'), HOME)
    tree = fromstring(to_behavior_tree(plan))
    assert tree.attrib == {"BTCPP_format": "4", "main_tree_to_execute": "Command"}
    action = tree.find("BehaviorTree/Sequence/Action")
    assert action.get("ID") == "say"
    assert action.get("text") == "(x) <b> & c"  # braces would be an entry of the blackboard
    assert action.get("listener") == "Ada"
    assert [port.get("name") for port in tree.findall("TreeNodesModel/Action/input_port")] == [
        "text",
        "listener",
    ]


PORTS = {
    '(is_a $1 "tea")': "tea",
    '(is_a $1 "drinks")': "drinks",
    '(is_a $1 "gizmo")': "gizmo",  # nothing of the ontology
    '(person $1) (name $1 "Ada")': "Ada",
    "(person $1)": "person",
    '(is_a $1 "tea") (at $1 "stool")': "",
    '(right_of $1 (λ$2:e (is_a $2 "tea")))': "",
    "(largest $1)": "",
    '(person $1) (gesture $1 "waving their hand")': "",
}


@pytest.mark.parametrize("robust", [None, Robust(2, 1.5)])
@pytest.mark.parametrize("said", PORTS)
def test_a_thing_of_which_only_the_noun_is_said_is_a_port_with_that(
    said: str, robust: Robust | None
) -> None:
    plan = plan_of(f"(find (λ$1:e {said}))")
    (action,) = (
        each
        for each in fromstring(to_behavior_tree(plan, robust)).iter("Action")
        if each.get("ID") == "find" and each.get("name")
    )
    port = action.get("target")
    assert port == PORTS[said] if PORTS[said] else port.startswith('json:{"kind":"description"')


def test_it_is_a_port_with_the_noun_of_what_it_stands_for() -> None:
    plan = plan_of('(sequence (find (λ$1:e (is_a $1 "tea"))) (take it))')
    assert 'thing="tea"' in to_behavior_tree(plan)


def test_a_robust_tree_tries_each_step_again_and_hands_on_what_fails() -> None:
    plan = plan_of('(sequence (go "attic") (bring (λ$1:e (is_a $1 "tea"))) (say (count UNKNOWN)))')
    xml = to_behavior_tree(plan, Robust(4, 2.5, "Give Up"))
    xml_schema().validate(xml)
    tree = fromstring(xml)
    steps = tree.findall("BehaviorTree/Sequence/Fallback")
    assert len(steps) == len(plan.steps)
    flat = fromstring(to_behavior_tree(plan)).findall("BehaviorTree/Sequence/Action")
    for step, number, alone in zip(steps, range(1, len(steps) + 1), flat, strict=True):
        retry, failed = step
        assert (retry.tag, retry.attrib) == ("RetryUntilSuccessful", {"num_attempts": "4"})
        (timeout,) = retry
        assert (timeout.tag, timeout.attrib) == ("Timeout", {"msec": "2500"})
        (action,) = timeout
        assert action.attrib == alone.attrib
        assert (failed.get("ID"), failed.get("number")) == ("Give_Up", str(number))
        assert failed.get("text") in alone.get("name")
    nodes = {each.get("ID") for each in tree.findall("TreeNodesModel/Action")}
    assert {each.get("ID") for each in tree.iter("Action")} == nodes


def test_a_long_sequence_is_cut_and_said() -> None:
    plan = plan_of("(sequence " + '(go "stool") ' * 80 + ")")
    assert len(plan.steps) == 50
    assert troubles(plan) == [Trouble.TOO_LONG]


@pytest.mark.parametrize(
    ("form", "n_questions"),
    [
        ('(put (λ$1:e (is_a $1 "<object>")) (λ$1:e (is_a $1 "<object>")))', 2),
        ('(bring (λ$1:e (near $1 (λ$2:e (is_a $2 "<object>"))) (is_a $1 "<object>")))', 2),
        ("(λ$1:e (guide (person $1)))", 1),  # the destination, beside a description
    ],
)
def test_each_open_argument_has_a_question_of_its_own(form: str, n_questions: int) -> None:
    plan = plan_of(form)
    asked = [said_in(plan, number, "question")["text"] for number in range(len(plan.steps) - 1)]
    assert [each.predicate for each in plan.steps[:-1]] == [ASK] * n_questions
    assert len(set(asked)) == n_questions


def test_a_command_of_which_nothing_is_understood_has_no_action_beside_its_question() -> None:
    plan = plan_of("(sequence UNKNOWN)")
    assert troubles(plan) == [Trouble.NOT_UNDERSTOOD, Trouble.NO_ACTION]
    assert [each.predicate for each in plan.steps] == [ASK]


@given(forms())
def test_every_form_has_a_plan_that_follows_the_schemas(form: Any) -> None:
    require_valid(make_plan(form, HOME))


@needs_corpus
def test_every_published_form_has_steps_and_names_its_problems() -> None:
    lines = (SHARED / "walker2019/gen/train.txt").read_text(encoding="utf-8").splitlines()
    for text in sorted(set(lines[1::2])):
        plan = plan_of(text)
        asks = text.count("UNKNOWN") + text.count("<")
        assert sum(step.predicate == ASK for step in plan.steps) == asks, text
        assert plan.is_executable == (not asks and '" cereal "' not in text), text


def test_categories_are_found_by_their_plural_and_singular() -> None:
    assert Entity("category", "drinks", (), {"singular": "drink"}) in HOME.entities
    value = dict(plan_of('(bring (λ$1:e (is_a $1 "drink")))').steps[0].arguments)["thing"]
    assert value.as_json()["conditions"][0]["values"][0]["entity_class"] == "category"


def test_the_starter_world_gives_a_robot_something_to_do() -> None:
    ontology, _ = read_ontology_folder(STARTER)
    said = "bring me the apple juice from the kitchen table, please"
    heard = Anonymizer(ontology).anonymize(said)
    form = read_form('(bring (λ$1:e (is_a $1 "<object>") (at $1 "<location>")))')
    given = deanonymize(form, heard, ontology)
    plan = make_plan(given.form, ontology, slots=given.slots)
    require_valid(plan)
    assert plan.is_executable
    assert plan.steps[0].text == "bring me the apple juice that is at the kitchen table"


def said_in(plan: Plan, step: int, argument: str) -> dict[str, Any]:
    value: dict[str, Any] = plan.as_json()["steps"][step]["arguments"][argument]
    return value


CUP = '(λ$1:e (is_a $1 "tea"))'
ANN = "(λ$1:e (person $1))"


@pytest.mark.parametrize(
    ("actions", "argument", "stands_for"),
    [
        (f"(find {CUP}) (take it)", "thing", "x1"),
        (f"(find {ANN}) (follow them)", "person", "x1"),
        (f"(find {CUP}) (find {ANN}) (bring it)", "thing", "x1"),
        (f"(find {CUP}) (find {ANN}) (follow them)", "person", "x2"),
        (f'(take {CUP}) (go (λ$1:e (is_a $1 "stool"))) (bring it)', "thing", "x1"),
        (
            f"(find {ANN}) (guide them (λ$1:e (near $1 {ANN.replace('1', '2')}))) (follow them)",
            "person",
            "x1",
        ),
        (f"(take {CUP}) (go (λ$1:e (near $1 {CUP.replace('1', '2')}))) (bring it)", "thing", "x1"),
        (
            f'(find (λ$1:e (is_a $1 "tea") (near $1 {ANN.replace("1", "2")}))) (take it)',
            "thing",
            "x1",
        ),
        (f"(find (λ$1:e (person $1) (holds $1 {CUP.replace('1', '2')}))) (take it)", "thing", "x2"),
    ],
)
def test_a_reference_is_what_was_described_before(
    actions: str, argument: str, stands_for: str
) -> None:
    plan = plan_of(f"(sequence {actions})")
    value = said_in(plan, -1, argument)
    assert value["id"] == stands_for and value["said"] in ("it", "them")
    assert "no_antecedent" not in troubles(plan)


def test_who_is_called_by_the_same_name_again_is_the_same_person() -> None:
    ada, bo = (f'(λ$1:e (person $1) (name $1 "{name}"))' for name in ("Ada", "Bo"))
    at = ada.replace("(person $1)", '(person $1) (at $1 "stool")')
    plan = plan_of(f'(sequence (find {at}) (follow {bo}) (say "hello" {ada}) (bring {CUP} {ada}))')
    people = [
        said_in(plan, *each)
        for each in ((0, "target"), (1, "person"), (2, "listener"), (3, "recipient"))
    ]
    assert [each["id"] for each in people] == ["x1", "x2", "x1", "x1"]
    assert [len(each["conditions"]) for each in people] == [3, 2, 2, 2]


def test_those_of_no_name_are_others_each() -> None:
    plan = plan_of(
        f'(sequence (find {ANN}) (follow {ANN}) (greet (λ$1:e (person $1) (name $1 "<name>"))))'
    )
    people = [
        value.id
        for step in plan.steps
        for _, value in step.arguments
        if isinstance(value, Described)
    ]
    assert people == ["x1", "x2", "x3"]


@pytest.mark.parametrize(
    "form",
    [
        '(put it "stool")',
        f'(sequence (find {CUP}) (say "hello" them))',
        f"(sequence (find {ANN}) (take it))",
        '(sequence (go (λ$1:e (is_a $1 "stool"))) (bring it))',
        "(bring it (λ$1:e (person $1) (holds $1 it)))",
    ],
)
def test_a_reference_that_stands_for_nothing_is_asked_for(form: str) -> None:
    plan = plan_of(form)
    assert "no_antecedent" in troubles(plan)
    assert not plan.is_executable
    assert any(step.predicate == ASK for step in plan.steps)


def test_after_a_question_about_somebody_they_are_meant() -> None:
    plan = plan_of(
        '(sequence (say (λ$1:e (λ$2:e (person $2) (name $2 $1) (at $2 "stool")))) (follow them))'
    )
    assert said_in(plan, -1, "person")["conditions"][0]["predicate"] == "person"


@pytest.mark.parametrize(
    "form",
    [
        '(sequence (go "attic") UNKNOWN)',
        '(sequence (go "attic") "do it")',
        '(sequence (go "attic") it)',
        '(and (go "attic") UNKNOWN)',
        '(sequence (go "attic") (λ$1:e (is_a $1 "tea")))',
        '(sequence (go "attic") (sequence))',
    ],
)
def test_a_part_of_a_command_that_is_no_action_is_asked_for(form: str) -> None:
    plan = plan_of(form)
    assert troubles(plan) == ["not_understood"] and not plan.is_executable
