"""What "or" joins is asked about; and so is what a form has no room for."""

from __future__ import annotations

import pytest

from annotations.language.forms import Text, read_form, read_wildcard, to_template
from annotations.language.grounding import Anonymizer, Evidence, deanonymize, open_slots_as_json
from annotations.language.grounding.deanonymizer import Deanonymized, Slot
from annotations.language.grounding.utterance_mentions import find_alternatives
from annotations.language.plans import make_plan
from annotations.language.templates.filling import fill_anonymized
from annotations.language.world import Entity, Ontology

TABLE = Ontology(
    (
        *(Entity("object", text) for text in ("red cup", "bowl", "tea", "plate", "box", "bag")),
        *(Entity("location", text) for text in ("shelf", "stool", "worktop", "piano")),
        *(Entity("room", text) for text in ("attic", "cellar")),
        *(Entity("name", text) for text in ("Bo", "Ada")),
    )
)
ANONYMIZER = Anonymizer(TABLE)
BRING = read_form("(bring (λ$1:e (is_a $1 {object 1})))")
BRING_FROM = read_form("(bring (λ$1:e (is_a $1 {object 1}) (at $1 {placement 1})))")
PUT = read_form("(put (λ$1:e (is_a $1 {object 1})) {placement 1})")
PUT_FROM = read_form("(put (λ$1:e (is_a $1 {object 1}) (at $1 {placement 1})) {placement 2})")
GIVE = read_form("(bring (λ$1:e (is_a $1 {object 1})) (λ$1:e (person $1) (name $1 {name 1})))")
BOTH = read_form(
    "(sequence (bring (λ$1:e (is_a $1 {object 1}))) (bring (λ$1:e (is_a $1 {object 2}))))"
)
FILL = read_form(
    "(sequence (open (λ$1:e (is_a $1 {object 1}))) "
    "(put (λ$1:e (is_a $1 {object 2})) (λ$1:e (is_a $1 {object 1}))))"
)


def said(*parts: str) -> tuple[Text, ...]:
    return tuple(read_wildcard(part) if part[0] == "{" else Text(part) for part in parts)  # type: ignore[misc]


# A grammar that has each form, so that nothing is left open because the form is unheard of.
GRAMMAR = Evidence(
    [
        (said("bring", "me", "the", "{object 1}"), BRING),
        (said("bring", "me", "the", "{object 1}", "from", "the", "{placement 1}"), BRING_FROM),
        (said("put", "the", "{object 1}", "on", "the", "{placement 1}"), PUT),
        (
            said(
                *("move", "the", "{object 1}", "from", "the", "{placement 1}"),
                *("to", "the", "{placement 2}"),
            ),
            PUT_FROM,
        ),
        (said("bring", "the", "{object 1}", "to", "{name 1}"), GIVE),
        (said("bring", "the", "{object 1}", "and", "then", "the", "{object 2}"), BOTH),
        (said("open", "the", "{object 1}", "and", "put", "the", "{object 2}", "in", "it"), FILL),
    ]
)


def hear(text: str, form: object, evidence: Evidence | None = GRAMMAR) -> Deanonymized:
    anonymized = ANONYMIZER.anonymize(text)
    return deanonymize(fill_anonymized(form, {}), anonymized, TABLE, evidence)  # type: ignore[arg-type]


def asked(text: str, form: object) -> list[str]:
    """Return what is offered for each open slot, as a person hears it."""
    slots = open_slots_as_json(hear(text, form), {})
    return [each["question"].partition("? ")[2] for each in slots]


@pytest.mark.parametrize("evidence", [None, GRAMMAR], ids=["English alone", "with the grammar"])
def test_or_between_two_things_for_one_slot_asks_which_and_names_them(
    evidence: Evidence | None,
) -> None:
    (slot,) = hear("bring me the red cup or the bowl", BRING, evidence).slots
    assert slot == Slot(
        (0, 0, 1),
        "<object>",
        "object",
        ("red cup", "bowl"),
        is_named=True,
        likely="red cup",
        is_choice=True,
    )
    assert slot.is_ambiguous


@pytest.mark.parametrize(
    ("text", "offered"),
    [
        ("bring me the red cup or the bowl", "Red cup or bowl?"),
        ("bring me the red cup or bowl, please", "Red cup or bowl?"),
        ("either the bowl or the big blue plate", "Bowl or plate?"),
        ("bring me the tea, the bowl or the plate", "Tea, bowl or plate?"),
        ("bring me tea, bowl, or maybe plate", "Tea, bowl or plate?"),
        ("bring me the tea or the bowl or the plate", "Tea, bowl or plate?"),
        ("bring me the red cup or the flurb", "Red cup or “flurb”?"),
        ("bring me the flurb or the red cup", "Red cup or “flurb”?"),
        ("bring me tea or flurb", "Tea or “flurb”?"),
        ("bring me the tea and the bowl", "Tea or bowl?"),
        ("bring me the tea or, if there is none, the bowl", "Tea or bowl?"),
    ],
)
def test_the_question_names_the_choices(text: str, offered: str) -> None:
    assert asked(text, BRING) == [offered]


def test_each_slot_of_an_or_is_asked_and_the_others_are_not() -> None:
    assert asked("move the tea from the shelf or the stool to the piano", PUT_FROM) == [
        "Shelf or stool?"
    ]
    assert asked("bring the tea or the bowl to Bo or Ada", GIVE) == ["Tea or bowl?", "Bo or Ada?"]
    assert asked("bring me the tea from the shelf or the bowl", BRING_FROM) == ["Tea or bowl?"]


def test_a_room_is_a_choice_beside_a_location_where_the_form_has_no_place_for_both() -> None:
    assert asked("put the tea on the shelf or in the attic", PUT) == ["Shelf or attic?"]
    both = read_form("(put (λ$1:e (is_a $1 {object 1}) (at $1 {room 1})) {placement 1})")
    assert asked("put the tea on the shelf or in the attic", both) == []


def test_or_beats_a_form_with_room_for_both() -> None:
    assert asked("bring the tea and then the bowl", BOTH) == []
    assert asked("bring the tea or the bowl", BOTH) == ["Tea or bowl?", "Tea or bowl?"]


def test_slots_that_share_a_value_wait_for_the_same_choice() -> None:
    slots = hear("open the box or the bag and put the tea in it", FILL).slots
    assert [(slot.value, slot.is_choice, slot.candidates) for slot in slots] == [
        (None, True, ("box", "bag")),
        ("tea", False, ("box", "bag", "tea")),
        (None, True, ("box", "bag")),
    ]


def test_more_places_than_the_form_has_room_for_are_asked_although_the_grammar_has_the_form() -> (
    None
):
    assert asked("take the tea, the worktop and the piano", BRING_FROM) == ["Worktop or piano?"]
    assert asked("go to the stool and bring me the tea from the shelf", BRING_FROM) == [
        "Shelf or stool?"
    ]


def test_what_the_grammar_says_with_more_names_than_slots_or_with_or_is_certain() -> None:
    call = read_form("(call {name 1})")
    lost = said("{name 2}", "is", "lost", ",", "call", "{name 1}")
    symbols = said("is", "it", "the", "{object 1}", "or", "the", "{object 2}")
    compare = read_form("(compare {object 1} {object 2})")
    known = Evidence([(lost, call), (symbols, compare)])
    for text, form in (
        ("Bo is lost, call Ada", '(call "Ada")'),
        ("is it the tea or the bowl", '(compare "tea" "bowl")'),
    ):
        pattern = call if "call" in form else compare
        result = hear(text, pattern, known)
        assert (to_template(result.form), result.open_slots) == (form, ())
    assert asked("Bo is lost, call Ada", call) == ["Ada or Bo?"]


@pytest.mark.parametrize(
    "text",
    [
        "bring me the tea or else",
        "bring me the tea or something",
        "bring me the tea or go home",
        "bring me the tea or grab the next one",
        "for better or worse bring me the tea",
        "or bring me the tea",
        "bring me the tea or",
        "bring me the tea or the tea",
    ],
)
def test_an_or_that_leaves_no_choice_asks_nothing(text: str) -> None:
    assert asked(text, BRING) == []


def test_numbered_tokens_do_not_decide_an_or() -> None:
    numbered = Anonymizer(TABLE, numbered=True).anonymize("bring me the tea or the bowl")
    form = read_form('(bring (λ$1:e (is_a $1 "<object1>")))')
    (slot,) = deanonymize(form, numbered, TABLE).slots
    assert (slot.value, slot.candidates) == (None, ("tea", "bowl"))


def test_members_are_found_in_the_order_of_the_text() -> None:
    heard = ANONYMIZER.anonymize("put the red tea, the bowl or a flurb on the shelf, Bo or Ada")
    found = [(each.spans, each.phrases) for each in find_alternatives(heard)]
    assert found == [((0, 1), ("flurb",)), ((3, 4), ())]


def test_a_plan_says_what_to_ask_an_operator() -> None:
    result = hear("bring me the tea or the flurb", BRING)
    (doubt,) = make_plan(result.form, TABLE, {}, {}, result.slots).problems
    assert doubt.hint == "ask whether it is “tea” or “flurb”"
