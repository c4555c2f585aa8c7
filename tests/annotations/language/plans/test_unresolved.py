"""What does not ground is handed on with what is known of it, and the rest stays a plan."""

from __future__ import annotations

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import Form, read_form
from annotations.language.grounding import Anonymizer, Deanonymized, deanonymize
from annotations.language.plans import (
    ASK,
    COMMAND,
    DialogueManager,
    Plan,
    apply_recipes,
    default_book,
    join,
    joint_plan_schema,
    make_plan,
    plan_schema,
    said_words,
)
from tests.annotations.language.random_forms import forms
from tests.annotations.language.sample_ontology import HOME

JSON_SCHEMA = jsonschema.Draft202012Validator(plan_schema())
JOINT_SCHEMA = jsonschema.Draft202012Validator(joint_plan_schema())
# A part of a command, and whether it grounds.
GROUNDED = ['(go "attic")', '(say "hello")', '(find (λ$1:e (is_a $1 "tea")))', "(follow it)"]
OPEN = [
    "UNKNOWN",
    '(go "<room>")',
    "(bring UNKNOWN)",
    '(take (λ$1:e (is_a $1 "<object>") (at $1 "stool")))',
    '(guide (λ$1:e (person $1) (name $1 "<name>")) "<location>")',
    '(say (count (λ$1:e (is_a $1 "<object>"))))',
    '(go "nowhere at all")',
    "(find (λ$1:e (biggest $1)))",
    '(put UNKNOWN "stool")',
]


def plan_of(form: Form, utterance: str = "", given: Deanonymized | None = None) -> Plan:
    slots = given.slots if given else ()
    plan = make_plan(form, HOME, slots=slots, utterance=utterance)
    JSON_SCHEMA.validate(plan.as_json())
    return plan


def heard(text: str, utterance: str) -> tuple[Plan, Deanonymized]:
    given = deanonymize(read_form(text), Anonymizer(HOME).anonymize(utterance), HOME)
    return plan_of(given.form, utterance, given), given


def require_each_once(plan: Plan) -> tuple[list[int], list[int]]:
    """Return the numbers of the steps that a robot can do, and of those that wait: all of them once, in order."""
    waiting = [number for each in plan.unresolved for number in each.steps]
    missed = [each.steps[0] for each in plan.unresolved if not each.predicate]
    steps = [each.number for each in plan.steps if each.predicate != ASK or each.number in missed]
    ready = [number for number in steps if number not in waiting]
    assert sorted([*ready, *waiting]) == steps
    assert waiting == sorted(set(waiting))
    assert bool(plan.is_executable) <= (not waiting)
    return ready, waiting


@given(st.lists(st.sampled_from([*GROUNDED[:-1], *OPEN]), min_size=1, max_size=8))
def test_steps_and_unresolved_ones_are_all_parts_of_a_command_once_and_in_order(
    parts: list[str],
) -> None:
    plan = plan_of(read_form(f"(sequence {' '.join(parts)})"))
    ready, waiting = require_each_once(plan)
    # What is counted is a step of its own before the one that tells it.
    counts = sum("count" in each for each in parts)
    assert len(ready) + len(waiting) == len(parts) + counts
    assert len(waiting) == sum(each in OPEN for each in parts) + counts
    said = [plan.steps[number - 1].predicate for number in (*ready, *waiting)]
    assert said.count("go") == sum("(go" in each for each in parts)
    for each in plan.unresolved:
        for gap in each.open:
            assert gap.question
            if gap.asked_in:
                asked = plan.steps[gap.asked_in - 1]
                assert asked.predicate == ASK and gap.asked_in <= each.steps[0]


@given(forms())
def test_every_form_is_covered(form: Form) -> None:
    require_each_once(plan_of(form))


def test_the_known_part_of_an_open_step_is_kept() -> None:
    plan, _ = heard(
        '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<location>")))',
        "bring me the flurb from the stool",
    )
    (waiting,) = plan.as_json()["unresolved"]
    described = waiting["arguments"]["thing"]["conditions"]
    assert [each["values"][0]["kind"] for each in described] == ["open", "entity"]
    (gap,) = waiting["open"]
    assert gap["words"] == [{"text": "flurb", "start": 13, "end": 18}]
    assert (gap["argument"], gap["entity_class"], gap["likely"]) == ("thing", "object", None)


def test_each_of_two_gaps_has_its_own_words() -> None:
    plan, _ = heard('(put (λ$1:e (is_a $1 "<object>")) "<location>")', "put the flurb on the glim")
    (waiting,) = plan.unresolved
    assert [[each.text for each in gap.words] for gap in waiting.open] == [["flurb"], ["glim"]]


def test_what_refers_to_an_open_step_waits_for_the_same_answer() -> None:
    plan, _ = heard(
        '(sequence (take (λ$1:e (is_a $1 "<object>"))) (go "<room>") (put it "stool"))',
        "take the flurb, go to the attic and put it on the stool",
    )
    ready, _ = require_each_once(plan)
    assert [plan.steps[number - 1].predicate for number in ready] == ["go"]
    assert [each.predicate for each in plan.unresolved] == ["take", "put"]
    first, last = plan.unresolved
    assert {gap.asked_in for gap in (*first.open, *last.open)} == {1}
    assert sum(each.predicate == ASK for each in plan.steps) == 1


def test_it_that_stands_for_what_nobody_named_is_asked_once() -> None:
    plan = plan_of(read_form('(sequence (bring UNKNOWN) (put it "stool"))'))
    assert sum(each.predicate == ASK for each in plan.steps) == 1
    assert [each.predicate for each in plan.unresolved] == ["bring", "put"]


def test_a_guess_is_not_known() -> None:
    plan, given = heard('(bring (λ$1:e (is_a $1 "<object>")))', "bring me the tea or the knife")
    (waiting,) = plan.unresolved
    (gap,) = waiting.open
    assert gap.likely == given.open_slots[0].likely and not gap.asked_in
    assert '"kind": "entity"' not in str(waiting.as_json()["arguments"]).replace("'", '"')
    referring, _ = heard(
        '(sequence (take (λ$1:e (is_a $1 "<object>"))) (put it "stool"))',
        "take the tea or the knife and put it on the stool",
    )
    assert len(referring.unresolved) == 2


@pytest.mark.parametrize("form", ["UNKNOWN", "(sequence UNKNOWN)"])
def test_a_command_of_which_nothing_is_understood_waits_with_all_its_words(form: str) -> None:
    plan = plan_of(read_form(form), "wibble wobble")
    (waiting,) = plan.unresolved
    (gap,) = waiting.open
    assert (waiting.predicate, gap.argument, gap.asked_in) == ("", COMMAND, 1)
    if form == "UNKNOWN":
        assert (gap.words[0].start, gap.words[0].end) == (0, 13)


@pytest.mark.parametrize(
    ("form", "utterance"),
    [
        ('(bring (λ$1:e (is_a $1 "<object>")))', "bring me the flurb"),
        ("(bring UNKNOWN)", "bring me the flurb"),
        ('(sequence (go "attic") UNKNOWN)', "go to the attic and wug the flurb"),
        ('(meet (λ$1:e (person $1) (name $1 "<name>")))', "meet Zed"),
        ('(bring (λ$1:e (is_a $1 "<object>")))', "bring me the tea or the knife"),
        ("UNKNOWN", "wibble wobble"),
    ],
)
def test_the_plan_asks_what_the_dialogue_asks(form: str, utterance: str) -> None:
    plan, _ = heard(form, utterance)
    manager = DialogueManager(HOME, {})
    state = manager.begin(read_form(form), manager.anonymizer.anonymize(utterance))
    assert state.prompt.startswith(plan.unresolved[0].open[0].question)


def test_words_are_found_where_they_stand_alone() -> None:
    (said, missing) = said_words(["red flurb", "tea"], "the steak, the Red  flurb")
    assert (said.start, said.end, missing.start) == (15, 25, None)


def test_a_joint_plan_has_the_open_steps_of_each_command_with_its_own_numbers() -> None:
    plans = []
    for form, utterance in (
        ('(sequence (go "attic") (put (λ$1:e (is_a $1 "tea")) "<location>"))', "go and put it"),
        ("UNKNOWN", "wibble"),
        ('(bring (λ$1:e (is_a $1 "knife")))', "bring me the knife"),
    ):
        plan, _ = heard(form, utterance)
        plans.append(apply_recipes(plan, default_book()))
    joint = join(
        plans, default_book(), utterances=["go and put it", "wibble", "bring me the knife"]
    )
    data = joint.as_json()
    JOINT_SCHEMA.validate(data)
    assert not data["is_executable"]
    first, second = data["unresolved"]
    assert (first["commands"], first["predicate"]) == ([1], "put")
    assert (second["commands"], second["predicate"], second["steps"]) == ([2], "", [])
    assert second["open"][0]["words"] == [{"text": "wibble", "start": 0, "end": 6}]
    waiting = [data["steps"][number - 1] for number in first["steps"]]
    assert waiting and all(1 in each["commands"] for each in waiting)
    assert data["steps"][first["open"][0]["asked_in"] - 1]["primitive"] == "ask_operator"
    ready = [each for each in data["steps"] if each["number"] not in first["steps"]]
    assert {number for each in ready for number in each["commands"]} >= {1, 3}
