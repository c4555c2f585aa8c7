from __future__ import annotations

import pytest

from annotations.language.recipes import read_book, spoken
from annotations.language.recipes.task_plan import TaskPlan
from tests.annotations.language.recipes.task_plans import task_plan

TEA = '(λ$1:e (is_a $1 "tea") (at $1 "attic"))'
ADA = '(λ$1:e (person $1) (name $1 "Ada") (at $1 "stool"))'


@pytest.mark.parametrize(
    ("form", "sentence"),
    [
        ('(go "attic")', "go to the attic."),
        (f"(bring {TEA})", "go to the attic, find a tea, and bring it to you."),
        (
            f'(sequence (go "attic") (find {TEA}) (bring it))',
            "go to the attic, find a tea, and bring it to you.",
        ),
        (f'(put {TEA} "stool")', "go to the attic, find a tea, and put it on the stool."),
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
        ("(go UNKNOWN)", "ask you “Where shall I go?” and go to the destination that you name."),
        ('(say "something about yourself")', "say something about myself."),
    ],
)
def test_a_plan_is_one_sentence(form, sentence):
    assert spoken(task_plan(form)) == f"I will {sentence}"


def test_a_primitive_without_words_is_said_by_its_name():
    book, _ = read_book("MoveBaseTo(goal)", "go(destination) -> MoveBaseTo(destination)")
    assert spoken(task_plan('(go "attic")', book)) == "I will move base to the attic."


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
