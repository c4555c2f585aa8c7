from __future__ import annotations

from dataclasses import replace

import pytest

from annotations.language.forms import Form, read_form
from annotations.language.texts.errors import Position, Severity
from annotations.language.world import (
    ArgumentKind,
    Predicate,
    PredicateKind,
    Signature,
    check_form,
    gloss,
    infer_signatures,
)
from tests.annotations.language.published import form_lines, needs_corpus

PLACE = Position("templates.txt", 4, 12)


def read_all(*texts: str) -> list[Form]:
    return [read_form(text) for text in texts]


KNOWN = infer_signatures(
    read_all(
        '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<location>")))',
        '(bring (λ$1:e (heaviest $1) (at $1 "<room>")) (λ$1:e (person $1) (name $1 "<name>")))',
        "(say (count (λ$1:e (heaviest $1 3))))",
        "(guide (λ$1:e (λ$2:e (person $1) (name $2 $1))) UNKNOWN)",
    )
)


def test_signatures_are_inferred_with_their_overloads() -> None:
    assert KNOWN["at"].signatures == (
        Signature((ArgumentKind.VARIABLE, "location")),
        Signature((ArgumentKind.VARIABLE, "room")),
    )
    assert {len(each.arguments) for each in KNOWN["heaviest"].signatures} == {1, 2}
    assert KNOWN["guide"].signatures == (Signature((ArgumentKind.LAMBDA, ArgumentKind.UNKNOWN)),)


def test_wildcards_of_templates_have_the_kind_of_their_class() -> None:
    inferred = infer_signatures(
        read_all("(go {room 1})", "(go {beacon})", "(go $place)", "(go {pron})")
    )
    kinds = {each.arguments[0] for each in inferred["go"].signatures}
    assert kinds == {"room", "location", ArgumentKind.ANY}


def test_what_heads_a_form_or_stands_in_an_action_is_an_action() -> None:
    actions = {name for name, each in KNOWN.items() if each.kind == PredicateKind.ACTION}
    assert actions == {"bring", "say", "count", "guide"}


def test_a_form_of_the_inferred_signatures_has_no_problem() -> None:
    form = read_form('(bring (λ$1:e (is_a $1 "<object3>") (at $1 "kitchen")))')
    assert check_form(form, KNOWN, PLACE) == []


@pytest.mark.parametrize(
    ("text", "named", "hint"),
    [
        ('(brin (λ$1:e (is_a $1 "<object>")))', ["brin"], "bring?"),
        ("(zzz UNKNOWN)", ["zzz"], ""),
        ("(guide UNKNOWN)", ["guide", "1"], "guide(lambda, unknown)"),
        ("(guide 1 2 3)", ["guide", "3"], "guide(lambda, unknown)"),
        (
            '(bring (λ$1:e (at $1 "<object>")))',
            ["2", "at", "object"],
            "at(variable, location) or at(variable, room)",
        ),
        ("(say 3)", ["1", "say", "number"], "say(form)"),
    ],
)
def test_a_mismatch_is_a_warning_with_its_place_and_a_hint(
    text: str, named: list[str], hint: str
) -> None:
    problem, *others = check_form(read_form(text), KNOWN, PLACE)
    assert not others
    assert problem.severity == Severity.WARNING
    assert problem.position == PLACE
    assert set(named) <= set(problem.message.split())
    assert problem.hint and hint in problem.hint


def test_a_nonterminal_as_predicate_or_argument_is_not_judged() -> None:
    assert check_form(read_form("(bring (λ$1:e ($oprop $1) (is_a $1 $object)))"), KNOWN) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("UNKNOWN", "a command that the robot does not understand"),
        ('(bring (λ$1:e (is_a $1 "<object>")))', "bring me the object"),
        (
            '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<location>")))',
            "bring me the object that is at the location",
        ),
        (
            '(bring (λ$1:e (is_a $1 "coke")) (λ$1:e (person $1) (name $1 "Alex") (at $1 "bar")))',
            "bring the coke to the person named Alex who is at the bar",
        ),
        ('(find (λ$1:e (is_a $1 "<category>")) 3)', "find three objects of the category"),
        (
            '(say (λ$1:e (λ$2:e (person $2) (gender $2 $1) (at $2 "<room>"))))',
            "tell me the gender of the person who is in the room",
        ),
        (
            '(bring (λ$1:e (λ$2:e (is_a $2 "<object>") (left_of $1 $2))) "<location>")',
            "bring me the object to the left of the object from the location",
        ),
        (
            '(λ$1:e (sequence (follow (person $1) (name $1 "<name>")) (guide $1 "current")))',
            "follow the person with the given name, then guide them back",
        ),
        (
            '(say (count (λ$1:e (and (person $1) (sitting $1) (at $1 "<room>")))))',
            "tell me the number of people who are sitting and in the room",
        ),
        ('(bring (λ$1:e (is $1 "<gesture>")))', "bring me the one who is making the gesture"),
        ("(find (λ$1:e (heaviest $1 3) (is_a $1 {kobject})))", "find the three heaviest objects"),
        (
            '(bring (λ$1:e (is_a $1 "chips") (at $1 "<location>")))',
            "bring me the chips that are at the location",
        ),
        ("(bring (λ$1:e (is_a $1)))", "bring me the object"),  # a parser may write it
    ],
)
def test_a_gloss_reads_as_a_sentence(text: str, expected: str) -> None:
    form = read_form(text)
    assert gloss(form, infer_signatures([form])) == expected
    assert gloss(form, {}) == expected


def test_defaults_are_made_from_names_and_kinds() -> None:
    form = read_form(
        '(tidy_up (λ$1:e (red $1) (colour $1 "blue") (next_to $1 "sofa") (tallest $1 2)) "<room>")'
    )
    assert gloss(form, {}) == (
        "tidy up the red two tallest objects whose colour is blue that are next to the sofa "
        "in the room"
    )


def test_a_pattern_of_ones_own_overrides_the_default() -> None:
    signature = Signature(("room",))
    mine = {"go": Predicate("go", PredicateKind.ACTION, (signature,), "drive | drive into {1}")}
    assert gloss(read_form('(go "<room>")'), mine) == "drive into the room"


def test_a_pattern_has_the_article_of_what_it_says() -> None:
    mine = {"wears": Predicate("wears", PredicateKind.DESCRIPTION, (), "_ in a {2:text} {3:text}")}
    form = '(find (λ$1:e (person $1) (wears $1 "{}" "coat")))'
    for colour, said in (("orange", "an orange"), ("red", "a red")):
        expected = f"find the person in {said} coat"
        assert gloss(read_form(form.format(colour)), mine) == expected


def test_a_predicate_of_nothing_but_actions_is_a_sequence() -> None:
    form = read_form('(first_then (go "<room>") (say (count (λ$1:e (person $1)))))')
    known = infer_signatures([form, read_form("(find (λ$1:e (follow (person $1) (male $1))))")])
    kinds = {name: each.kind for name, each in known.items()}
    assert kinds["first_then"] is PredicateKind.SEQUENCE
    assert PredicateKind.SEQUENCE not in {kinds[name] for name in ("follow", "say", "go", "find")}
    assert gloss(form, known) == "go to the room, then tell me the number of people"


def test_describing_each_other_does_not_go_round_forever() -> None:
    form = read_form("(find (λ$1:e (λ$2:e (near $1 $2) (near $2 $1) (near $1 $1))))")
    assert gloss(form, {}).startswith("find the object that is near")


@needs_corpus
def test_the_published_forms_have_38_predicates_and_fit_them() -> None:
    forms = {read_form(line) for line in form_lines("gen", "gen_logical")}
    known = infer_signatures(forms)
    assert (len(forms), len(known)) == (101, 38)
    assert [problem for form in forms for problem in check_form(form, known)] == []


@needs_corpus
@pytest.mark.parametrize(
    "text",
    [
        '(guide "Michael" "sofa" "kitchen")',
        '(hand_over "Michael" "sofa" "kitchen")',
        '(follow "Michael" "sofa" "kitchen")',
        '(find (lambda $1 e (beside $1 "Michael" "sofa" "kitchen")))',
        '(find (lambda $1 e (at $1 "Michael" "sofa" "kitchen")))',
    ],
)
def test_every_argument_is_said_before_the_predicate_is_declared(text: str) -> None:
    form = read_form(text)
    one_less = infer_signatures([read_form(text.replace(' "kitchen"', ""))])
    for known in ({}, infer_signatures([form]), one_less):
        assert {"Michael", "sofa", "kitchen"} <= set(gloss(form, known).split()), known


def test_what_a_gloss_leaves_out_on_purpose_stays_left_out() -> None:
    form = read_form('(go "kitchen" "fast")')
    (predicate,) = infer_signatures([form]).values()
    assert gloss(form, {"go": replace(predicate, gloss="drive to {1}")}) == "drive to the kitchen"


@pytest.mark.parametrize(
    ("named", "said"),
    [({}, "at"), ({"kitchen": "room"}, "in"), ({"kitchen": "location"}, "at")],
)
def test_a_thing_is_in_a_room_and_at_a_location(named: dict[str, str], said: str) -> None:
    form = read_form('(find (lambda $1 e (is_a $1 "hammer") (at $1 "kitchen")))')
    assert gloss(form, {}, named=named) == f"find the hammer that is {said} the kitchen"


def test_a_name_has_no_article() -> None:
    assert gloss(read_form('(greet "Michael" "sofa")'), {}) == "greet Michael with the sofa"


def test_every_published_form_has_a_gloss_of_its_own() -> None:
    forms = {read_form(line) for line in form_lines("gen", "gen_logical")}
    known = infer_signatures(forms)
    assert len({gloss(form, known) for form in forms}) == len(forms)
    for form in forms:
        words = gloss(form, known)
        assert not set('_{}$⟨⟩"') & set(words), words
