"""For one gap there is one question: in the open slots, in both plans, in what the robot says, in a dialogue."""

from __future__ import annotations

import pytest

from annotations.language.forms import read_form
from annotations.language.grounding import Anonymizer, deanonymize, open_slots_as_json
from annotations.language.plans import (
    ASK,
    DialogueManager,
    Phase,
    Plan,
    apply_recipes,
    default_book,
    make_plan,
    spoken,
)
from annotations.language.world import Entity, Ontology

THINGS = ("tea", "jam", "bread", "salt", "knife", "bowl")
ROOMS = ("attic", "cellar")  # so few that a question names them
PEOPLE = ("Ada", "Bo", "Cy", "Dee", "Eve")
WORLD = Ontology(
    (
        *(Entity("object", each) for each in THINGS),
        *(Entity("room", each) for each in ROOMS),
        *(Entity("name", each) for each in PEOPLE),
    )
)
BRING = '(bring (λ$1:e (is_a $1 "<object>")))'
CASES = {
    "bring me the flurb": BRING,
    "bring me something": BRING,
    "bring it to me": "(bring UNKNOWN)",
    "bring me the wug to eat": "(bring UNKNOWN)",
    "go somewhere": '(go "<room>")',
    "go to the snorf": '(go "<room>")',
    "go to the pantry or the snorf": '(go "<room>")',
    "meet Zed in the attic": '(meet (λ$1:e (person $1) (name $1 "<name>") (at $1 "<room>")))',
    "meet somebody in the snorf": (
        '(meet (λ$1:e (person $1) (name $1 "<name>") (at $1 "<room>")))'
    ),
    "take the flurb and go to the snorf": (
        '(sequence (take (λ$1:e (is_a $1 "<object>"))) (go "<room>"))'
    ),
    "take the tea and then the flurb": (
        '(sequence (take (λ$1:e (is_a $1 "<object0>"))) (take (λ$2:e (is_a $2 "<object1>"))))'
    ),
}


def questions_in(plan: Plan) -> list[str]:
    asking = [each for each in plan.steps if each.predicate == ASK]
    return [str(dict(each.arguments)["question"].as_json()["text"]) for each in asking]


@pytest.mark.parametrize("utterance", CASES)
def test_all_ask_the_same(utterance: str) -> None:
    heard = Anonymizer(WORLD).anonymize(utterance)
    given = deanonymize(read_form(CASES[utterance]), heard, WORLD)
    asked = [each["question"] for each in open_slots_as_json(given, {}) if each["likely"] is None]
    assert asked
    plan = make_plan(given.form, WORLD, slots=given.slots)
    assert questions_in(plan) == asked
    task_plan = apply_recipes(plan, default_book())
    said = spoken(task_plan)
    for question in asked:
        assert said.count(f"“{question}”") == asked.count(question)
    dialogue = DialogueManager(WORLD, {})
    state = dialogue.begin(read_form(CASES[utterance]), heard)
    assert state.phase is Phase.ASKING
    assert state.prompt.startswith(open_slots_as_json(given, {})[0]["question"])


def test_an_unknown_word_is_asked_about_by_the_plan() -> None:
    heard = Anonymizer(WORLD).anonymize("bring me the flurb")
    given = deanonymize(read_form(BRING), heard, WORLD)
    (question,) = questions_in(make_plan(given.form, WORLD, slots=given.slots))
    assert "“flurb”" in question
    (without,) = questions_in(make_plan(given.form, WORLD))
    assert without == "What shall I bring you?"
