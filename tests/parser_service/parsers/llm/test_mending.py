"""What a language model wrote is held to the world: names, predicates, references."""

from __future__ import annotations

import random

import pytest

from annotations.language.forms import (
    UNKNOWN,
    Application,
    Constant,
    Unknown,
    canonical_text,
    read_form,
    walk,
)
from annotations.language.world import Entity, Ontology, infer_signatures
from parser_service.parsers.llm.mending import Mender, tokens_in

FORMS = [
    read_form(text)
    for text in (
        '( go " <room> " )',
        '( go " <location> " )',
        '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <location> " ) ) )',
        '( bring ( lambda $1 e ( is_a $1 " <category> " ) ( at $1 " <room> " ) ) )',
        '( find ( lambda $1 e ( person $1 ) ( name $1 " <name> " ) ) )',
        '( answer " question " )',
        '( sequence ( find ( lambda $1 e ( person $1 ) ) ) ( follow them " <room> " ) )',
        '( sequence ( take ( lambda $1 e ( is_a $1 " <object> " ) ) ) ( bring it ) )',
    )
]
ONTOLOGY = Ontology(
    (
        Entity("room", "kitchen"),
        Entity("room", "living room"),
        Entity("location", "dining table", ("table",)),
        Entity("object", "coke"),
        Entity("object", "orange juice"),
        Entity("category", "drinks"),
        Entity("name", "Robin"),
        Entity("name", "Robyn"),
    )
)
MENDER = Mender(FORMS, infer_signatures(FORMS), ONTOLOGY)


def mended(form: str, utterance: str) -> tuple[str, tuple[str | None, ...]]:
    result = MENDER.mend(read_form(form), utterance)
    return canonical_text(result.form), result.values


@pytest.mark.parametrize("form", FORMS, ids=canonical_text)
def test_a_form_of_training_stays_as_it_is(form):
    result = MENDER.mend(form, "whatever was said")
    assert canonical_text(result.form) == canonical_text(form)
    assert result.values == (None,) * tokens_in(form)


@pytest.mark.parametrize(
    ("written", "said", "form", "value"),
    [
        # The names of entities become class tokens with those entities.
        ("kitchen", "go to the kitchen", "<room>", "kitchen"),
        ("Living_Room", "go to the living room", "<room>", "living room"),
        ("table", "go to the table", "<location>", "dining table"),
        # A misspelt one is the nearest.
        ("kitchn", "go to the kitchen", "<room>", "kitchen"),
        ("diningtable", "over to the dining table", "<location>", "dining table"),
        # Whoever speaks has not said it: models invent.
        ("kitchen", "go there", "<room>", None),
        # Nothing has this name; the utterance tells the class.
        ("pantry", "go to the living room", "<room>", None),
        ("<rom>", "go to the living room", "<room>", None),
    ],
)
def test_a_name_is_one_of_the_world(written, said, form, value):
    assert mended(f'( go " {written} " )', said) == (f'( go " {form} " )', (value,))


@pytest.mark.parametrize("written", ["pantry", "coke", "<object>", "<planet>"])
def test_a_name_that_may_be_anything_is_asked_for(written):
    assert mended(f'( go " {written} " )', "go there") == ("( go UNKNOWN )", ())


def test_a_name_that_two_are_equally_like_is_asked_for():
    form = '( find ( lambda $1 e ( person $1 ) ( name $1 " Robxn " ) ) )'
    said = "find Robin and Robyn"
    assert mended(form, said) == (form.replace("Robxn", "<name>"), (None,))


@pytest.mark.parametrize(
    ("written", "form"),
    [
        ('( og " <room> " )', "UNKNOWN"),  # too short to be sure
        ('( folow them " <room> " )', "follow"),
        ('( Follow them " <room> " )', "follow"),
        ('( fellow them " <room> " )', "UNKNOWN"),  # a word of its own
        ('( paint " <room> " )', "UNKNOWN"),
        ('( go " <room> " " <room> " )', "UNKNOWN"),  # no such use
        ("( go it it it )", "UNKNOWN"),
    ],
)
def test_an_action_is_one_of_the_world_and_keeps_its_place_where_it_is_not(written, form):
    first = "( find ( lambda $1 e ( person $1 ) ) )"
    result, values = mended(f"( sequence {first} {written} )", "do it")
    second = 'follow them " <room> "' if form == "follow" else ""
    assert result == f"( sequence {first} {f'( {second} )' if second else form} )"
    assert values == ((None,) if second else ())
    assert second or mended(written, "do it") == ("UNKNOWN", ())


def test_what_is_said_of_a_thing_is_never_left_out():
    form = '( bring ( lambda $1 e ( is_a $1 " coke " ) ( near $1 " kitchen " ) ) )'
    assert mended(form, "bring me the coke near the kitchen") == ("( bring UNKNOWN )", ())


def test_values_belong_to_the_tokens_that_are_left():
    form = '( sequence ( bring ( lambda $1 e ( is_a $1 " coke " ) ( on $1 " table " ) ) ) ( go " kitchen " ) )'
    result = mended(form, "bring the coke from the table and go to the kitchen")
    assert result == ('( sequence ( bring UNKNOWN ) ( go " <room> " ) )', ("kitchen",))


def test_texts_of_training_may_be_written_and_others_not():
    assert mended('( answer " question " )', "answer me") == ('( answer " question " )', ())
    assert mended('( answer " riddle " )', "answer me") == ("( answer UNKNOWN )", ())


def test_a_reference_needs_something_before_it():
    loose = '( sequence ( go " <room> " ) ( follow them " <room> " ) )'
    assert mended(loose, "go and follow them")[0] == loose.replace("them", "UNKNOWN")
    bound = "( sequence ( find ( lambda $1 e ( person $1 ) ) ) ( follow them ) )"
    forms = [*FORMS, read_form(bound)]
    result = Mender(forms, infer_signatures(forms), ONTOLOGY).mend(read_form(bound), "")
    assert canonical_text(result.form) == bound


def test_whatever_is_written_the_answer_holds_what_the_world_has_and_stays_when_mended_again():
    drawn = random.Random(4)
    predicates = infer_signatures(FORMS)
    nodes = [each for form in FORMS for each in walk(form) if isinstance(each, Application)]
    names = [str(each.predicate) for each in nodes] + ["fly", "is", "sequenc", "broing"]
    leaves = ["kitchen", "coke", "<room>", "<star>", "moon", "drinks", "Robin"]

    def shaken(form):
        if isinstance(form, Constant) and drawn.random() < 0.4:
            return Constant(drawn.choice(leaves))
        if isinstance(form, Application):
            name = drawn.choice(names) if drawn.random() < 0.2 else form.predicate
            return Application(name, tuple(shaken(each) for each in form.arguments))
        if hasattr(form, "bodies"):
            return type(form)(form.variable, form.type, tuple(map(shaken, form.bodies)))
        return form

    for _ in range(2_000):
        written = shaken(drawn.choice(FORMS))
        result = MENDER.mend(written, "bring the coke from the kitchen to Robin")
        assert len(result.values) == tokens_in(result.form)
        for node in walk(result.form):
            assert not isinstance(node, Application) or node.predicate in predicates
            if isinstance(node, Constant):
                assert node.token_class in ONTOLOGY.classes or node.value == "question"
        again = MENDER.mend(result.form, "")
        assert again.form == result.form or isinstance(result.form, Unknown)
        assert UNKNOWN not in walk(result.form) or written != result.form
