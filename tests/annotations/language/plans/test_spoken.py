from __future__ import annotations

import re

import pytest
from hypothesis import given

from annotations.language.forms import read_form
from annotations.language.plans import (
    EffectKind,
    apply_recipes,
    default_book,
    join,
    make_plan,
    read_book,
    spoken,
)
from annotations.language.plans.task_plan import TaskPlan
from annotations.language.world import Predicate, PredicateKind, read_signatures
from tests.annotations.language.plans.task_plans import task_plan
from tests.annotations.language.random_commands import commands
from tests.annotations.language.sample_ontology import HOME

TEA = '(λ$1:e (is_a $1 "tea") (at $1 "attic"))'
ADA = '(λ$1:e (person $1) (name $1 "Ada") (at $1 "stool"))'


@pytest.mark.parametrize(
    ("form", "sentence"),
    [
        ('(go "attic")', "go to the attic."),
        (f"(bring {TEA})", "go to the attic, find a tea, take it, and bring it to you."),
        (
            f'(sequence (go "attic") (find {TEA}) (bring it))',
            "go to the attic, find a tea, take it, and bring it to you.",
        ),
        (f'(put {TEA} "stool")', "go to the attic, find a tea, take it, and put it on the stool."),
        (
            f"(bring {TEA} {ADA})",
            "go to the attic, find a tea, take it, go to the stool, find Ada, and give it to them.",
        ),
        (
            f'(sequence (find {ADA}) (say "a joke" them))',
            "go to the stool, find Ada, and tell them a joke.",
        ),
        (
            '(say (count (λ$1:e (person $1) (gesture $1 "waving their hand") (at $1 "attic"))))',
            "go to the attic, count the people who are waving their hand, come back to you, and tell you "
            "the number of the people who are waving their hand.",
        ),
        (
            '(say (λ$1:e (λ$2:e (person $2) (name $2 $1) (at $2 "attic"))))',
            "go to the attic, find the person, find out their name, come back to you, and tell you their name.",
        ),
        (
            f'(answer "What is up?" {ADA})',
            "go to the stool, find Ada, and answer their question “What is up?”.",
        ),
        (
            '(sequence (find (λ$1:e (is_a $1 "drinks") (at $1 "attic"))) (take it))',
            "go to the attic, find the drinks, and take it.",
        ),
        (
            f'(sequence (take (λ$1:e (is_a $1 "cookies"))) (go "attic") (bring it {ADA}))',
            "find the cookies, take them, go to the attic, go to the stool, find Ada, and give the cookies to them.",
        ),
        ('(say "what you are called")', "say what I am called."),
        (
            '(say (λ$1:e (λ$2:e (person $2) (name $2 $1) (at $2 "attic"))) (λ$3:e (person $3) (at $3 "stool")))',
            "go to the attic, find the person, find out their name, go to the stool, find the person, and tell "
            "them the name of the person in the attic.",
        ),
        (
            "(bring UNKNOWN)",
            "ask you “What shall I bring you?”, find the thing that you name, take it, and bring it to you.",
        ),
        ("(go UNKNOWN)", "ask you “Where shall I go?” and go to the destination that you name."),
        (
            '(say "<whattosay>")',
            "ask you “What shall I tell you?” and tell you the sentence that you name.",
        ),
        ('(say "something about yourself")', "say something about myself."),
    ],
)
def test_a_plan_is_one_sentence(form, sentence):
    assert spoken(task_plan(form)) == f"I will {sentence}"


@given(commands(most=3))
def test_each_thing_that_is_taken_is_said_to_be(form):
    plan = task_plan(form)
    taking = [each for each in plan.steps if each.primitive.effect(EffectKind.TAKES)]
    assert len(re.findall(r"\btake (?!you)", spoken(plan))) == len(taking)


@pytest.mark.parametrize(
    ("forms", "sentence"),
    [
        (
            (f"(take {TEA})", f"(take {TEA})"),
            "find a tea, take it, find another tea, take it, and come back to you.",
        ),
        (  # what the robot tells could be "it" too
            ('(say (count (λ$1:e (is_a $1 "cookies") (at $1 "attic"))))', f"(bring {TEA})"),
            "tell you the number of the cookies, and give the tea to you.",
        ),
    ],
)
def test_a_joint_plan_says_what_it_means(forms, sentence):
    joint = join([task_plan(each) for each in forms], default_book())
    assert spoken(joint.plan).endswith(sentence)


def test_the_words_of_the_robot_stay_as_they_are():
    book, _ = read_book(
        'say(text) "say “{text}”": speaks', 'go(destination) -> say("I will come to you")'
    )
    assert spoken(task_plan('(go "attic")', book)) == "I will say “I will come to you”."


WORN = Predicate(
    "wears",
    PredicateKind.DESCRIPTION,
    read_signatures("(variable, text, text)"),
    gloss="_ in a {2:text} {3:text}",
)


def test_what_many_people_wear_is_a_plural():
    worn = '(λ$1:e (person $1) (wears $1 "orange" "coat") (at $1 "attic"))'
    plan = make_plan(read_form(f"(say (count {worn}))"), HOME, {"wears": WORN})
    said = spoken(apply_recipes(plan, default_book()))
    assert "count the people in orange coats," in said
    plan = make_plan(read_form(f"(find {worn})"), HOME, {"wears": WORN})
    assert "find the person in an orange coat" in spoken(apply_recipes(plan, default_book()))


def test_a_primitive_without_words_is_said_by_its_name():
    book, _ = read_book("MoveBaseTo(goal)", "go(destination) -> MoveBaseTo(destination)")
    assert spoken(task_plan('(go "attic")', book)) == "I will move base to the attic."


def test_a_plan_that_only_asks_is_its_question():
    assert spoken(task_plan("UNKNOWN")) == "I did not understand that. What shall I do?"


def test_several_questions_are_asked_together():
    form = '(meet (λ$1:e (person $1) (name $1 "<name>") (at $1 "<room>")))'
    assert spoken(task_plan(form)).startswith(
        "I will ask you “Who shall I meet?” and “Which room is the person in?”, go to the room"
    )


def test_of_several_answers_their_order_tells_which_is_meant():
    assert spoken(task_plan('(sequence (go "<room>") (go "<room>"))')) == (
        "I will ask you “Which room shall I go to?” and “Which room shall I go to?”, "
        "go to the first room that you name, and go to the second room that you name."
    )


def test_nothing_to_do_is_said():
    assert spoken(TaskPlan(())) == "I have nothing to do."


def test_each_step_is_said_on_its_own():
    assert [step.text for step in task_plan(f"(bring {TEA})").steps] == [
        *(
            "go to the attic",
            "find a tea",
            "take the tea",
            "come back to you",
            "give the tea to you",
        )
    ]
