"""Questions for what a form leaves open are ones that a person would say."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import pairwise

import pytest
from hypothesis import given

from annotations.language.forms import DEFAULT_CLASSES, EntityClass, EntityClasses, Form, read_form
from annotations.language.grounding.deanonymizer import filled, slots_of
from annotations.language.templates import (
    generate,
    read_generator_folder,
)
from annotations.language.texts import article
from annotations.language.world import (
    Predicate,
    PredicateKind,
    ask_for,
    gloss,
    infer_signatures,
    pattern_of_name,
    read_signatures,
)
from tests.annotations import starter
from tests.annotations.exchange import test_competition_world as competition
from tests.annotations.language.published import SHARED, needs_corpus
from tests.annotations.language.random_forms import forms

SPOKEN = re.compile(r"(?:[A-Z][\w'-]*)(?: [\w'-]+)*\?")
ONE_OF_MANY = re.compile(r"\bthe \w+est \w*[^s\W]s\?")  # "Where is the biggest drinks?"
LONGEST = 15  # words
# An entity of each class, to be put into the other slots of a form.
ENTITIES = {
    "object": "apple",
    "category": "drinks",
    "name": "Ada",
    "location": "shelf",
    "room": "kitchen",
    "gesture": "waving",
    "pose": "sitting",
    "colour": "orange",
    "garment": "coat",
    "topic": "the time",
    "whattosay": "a joke",
}


def questions(
    form: Form, predicates: Mapping[str, Predicate], classes: EntityClasses = DEFAULT_CLASSES
) -> list[str]:
    """The questions for the slots of a form: while all others are open too, and while none is."""
    slots = list(slots_of(form))
    asked = [ask_for(form, s.path, s.entity_class, predicates, classes) for s in slots]
    for slot in slots:
        full, named = form, {}
        for other in slots:
            if other is not slot and other.entity_class:
                entity = ENTITIES.get(other.entity_class, other.entity_class)
                full, named[entity] = filled(full, other.path, entity), other.entity_class
        asked.append(ask_for(full, slot.path, slot.entity_class, predicates, classes, named))
    return asked


def question(form: str, predicates: Mapping[str, Predicate] | None = None) -> str:
    """The question for the first slot of a form."""
    read = read_form(form)
    slot = next(slots_of(read))
    named = {text: entity_class for entity_class, text in ENTITIES.items()}
    classes = DEFAULT_CLASSES.with_rows([EntityClass("tool", "tool", "tools", 10, "tool")])
    return ask_for(read, slot.path, slot.entity_class, predicates or {}, classes, named)


@pytest.mark.parametrize(
    ("form", "asked"),
    [
        ('(bring (λ$1:e (is_a $1 "<object>")))', "What shall I bring you?"),
        (
            '(bring (λ$1:e (is_a $1 "<object>")) (λ$1:e (person $1) (name $1 "Ada")))',
            "What shall I bring to Ada?",
        ),
        (
            '(bring (λ$1:e (is_a $1 "<object>") (at $1 "kitchen")))',
            "Which object in the kitchen shall I bring you?",
        ),
        ("(bring UNKNOWN)", "What shall I bring you?"),
        (
            '(bring (λ$1:e (is_a $1 "apple")) (λ$1:e (person $1) (name $1 "<name>")))',
            "Who shall I bring the apple to?",
        ),
        ('(bring it (λ$1:e (person $1) (name $1 "<name>")))', "Who shall I bring it to?"),
        ('(bring (λ$1:e (is_a $1 "apple") (at $1 "<room>")))', "Where shall I get the apple from?"),
        (
            '(take (λ$1:e (is_a $1 "apple") (at $1 "<location>")))',
            "Where shall I take the apple from?",
        ),
        ('(go "<room>")', "Which room shall I go to?"),
        ('(go "<location>")', "Where shall I go?"),
        ("(go UNKNOWN)", "Where shall I go?"),
        ('(clear "<location>")', "Which place shall I clear?"),
        ('(put (λ$1:e (is_a $1 "apple")) "<location>")', "Where shall I put the apple?"),
        ('(put it "<location>")', "Where shall I put it?"),
        ('(put (λ$1:e (is_a $1 "<object>")) "shelf")', "What shall I put on the shelf?"),
        ('(guide them "<room>")', "Which room shall I guide them to?"),
        ("(follow UNKNOWN)", "Who shall I follow?"),
        ('(say UNKNOWN (λ$1:e (person $1) (name $1 "Ada")))', "What shall I say to Ada?"),
        ('(answer "<question>" them)', "Which question shall I answer?"),
        (
            '(follow (λ$1:e (person $1) (gesture $1 "<gesture>") (at $1 "kitchen")))',
            "Which gesture is the person in the kitchen making?",
        ),
        (
            '(bring (λ$1:e (largest $1) (is_a $1 "<object>")))',
            "Among which things shall I look for the largest one?",
        ),
        (
            '(bring (λ$1:e (right_of $1 (λ$2:e (is_a $2 "<object>")))))',
            "What is to the left of it?",
        ),
        ('(sequence (go "kitchen") UNKNOWN)', "What shall I do?"),
        ('(λ$1:e (is_a $1 "<tool>"))', "Which tool do you mean?"),
    ],
)
def test_what_is_open_is_asked_for(form: str, asked: str) -> None:
    assert question(form) == asked


def test_what_a_λ_around_an_action_describes_is_what_the_action_is_done_with() -> None:
    form = '(λ$1:e (person $1) (name $1 "<name>") (follow $1 "kitchen"))'
    assert question(form, starter.predicates()) == "Who shall I follow to the kitchen?"


def test_words_of_a_world_are_asked_for_by_their_names() -> None:
    signatures = read_signatures(
        "(tool, location)", DEFAULT_CLASSES.with_rows([EntityClass("tool", "", "", 1, "tool")])
    )
    pattern = pattern_of_name("polish", True, signatures)
    own = {"polish": Predicate("polish", PredicateKind.ACTION, signatures, pattern)}
    assert question('(polish "<tool>" "shelf")', own) == "Which tool shall I polish at the shelf?"
    assert question('(polish UNKNOWN "shelf")', own) == "Which tool shall I polish at the shelf?"
    assert question('(polish "brush" "<location>")', own) == "Where shall I polish the brush?"
    assert question('(sand (λ$1:e (colour $1 "<tint>")))') == "What is the colour of it?"
    assert question('(sand (λ$1:e (has_lid $1 "<tool>")))') == "Which tool do you mean?"


def test_a_text_that_is_said_stays_as_it_is() -> None:
    asked = question('(say "tell me it" (λ$1:e (person $1) (name $1 "<name>")))')
    assert asked == "Who shall I tell tell me it?"


def require_spoken(asked: str) -> None:
    assert SPOKEN.fullmatch(asked), asked
    assert "___" not in asked and len(asked.split()) <= LONGEST, asked
    words = asked.lower().rstrip("?").split()
    assert not any(one == other for one, other in pairwise(words)), asked
    articles = [(one, article(other)) for one, other in pairwise(words) if one in ("a", "an")]
    assert all(one == right for one, right in articles), asked
    assert not ONE_OF_MANY.search(asked), asked


def require_definite(said: str, classes: EntityClasses = DEFAULT_CLASSES) -> None:
    """What is open is "the colour", whichever it is; "a colour garment" is nothing."""
    nouns = "|".join(classes.noun(token) for token in classes.tokens)
    assert not re.search(rf"\ban? (?:{nouns})\b", said), said


def test_whatever_the_household_leaves_open_can_be_asked() -> None:
    texts = {each.form_text for each in starter.generated().expansions}
    for text in texts:
        for asked in questions(read_form(text), starter.predicates()):
            require_spoken(asked)
            require_definite(asked)
        require_definite(gloss(read_form(text), starter.predicates()))


def test_whatever_the_competition_leaves_open_can_be_asked() -> None:
    classes = competition.ontology().classes
    predicates = competition.predicates()
    for text in {each.form_text for each in competition.sample().expansions}:
        for asked in questions(read_form(text), predicates, classes):
            require_spoken(asked)
            require_definite(asked, classes)
        require_definite(gloss(read_form(text), predicates, classes), classes)


@needs_corpus
def test_whatever_the_published_generator_leaves_open_can_be_asked() -> None:
    """That of 2018; the one of 2019 comes without forms."""
    categories = read_generator_folder(SHARED / "generator-2018").categories()
    read = dict.fromkeys(read_form(each.form_text) for each in generate(categories).expansions)
    predicates = infer_signatures(read)
    assert read
    for form in read:
        for asked in questions(form, predicates):
            require_spoken(asked)
            require_definite(asked)
        require_definite(gloss(form, predicates))


@given(forms())
def test_every_slot_of_every_form_has_a_question(form: Form) -> None:
    for slot in slots_of(form):
        asked = ask_for(form, slot.path, slot.entity_class, {})
        assert asked[0].isupper() and asked.endswith("?")
