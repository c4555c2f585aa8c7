from __future__ import annotations

import pytest
from hypothesis import given

from annotations.language.plans import plan_key, same_plan
from tests.annotations.language.plans.task_plans import task_plan
from tests.annotations.language.random_commands import commands

TEA = '(is_a $1 "tea")'
IN_ATTIC = '(at $1 "attic")'
WAVING = '(person $1) (gesture $1 "waving their hand")'


@pytest.mark.parametrize(
    ("one", "other"),
    [
        # The example of the rulebook: get me a … from the …; go to the …, find a …, and bring it to me.
        (
            f"(bring (λ$1:e {TEA} {IN_ATTIC}))",
            f'(sequence (go "attic") (find (λ$1:e {TEA})) (bring it))',
        ),
        (
            f"(bring (λ$1:e {TEA} {IN_ATTIC}))",
            f"(sequence (take (λ$1:e {TEA} {IN_ATTIC})) (bring it))",
        ),
        (
            f"(bring (λ$1:e {TEA} {IN_ATTIC}))",
            f"(sequence (take (λ$1:e {TEA} {IN_ATTIC})) (bring (λ$2:e {TEA.replace('1', '2')})))",
        ),
        (
            f"(bring (λ$1:e {TEA} {IN_ATTIC}))",
            f"(bring (λ$7:e {IN_ATTIC} {TEA}))".replace("$1", "$7"),
        ),
        (
            f"(follow (λ$1:e {WAVING} {IN_ATTIC}))",
            f"(sequence (find (λ$1:e {WAVING} {IN_ATTIC})) (follow them))",
        ),
        (
            f'(say "a joke" (λ$1:e {WAVING} {IN_ATTIC}))',
            f'(sequence (go "attic") (go "attic") (find (λ$1:e {WAVING})) (say "a joke" them))',
        ),
        (f'(put (λ$1:e {TEA}) "stool")', f'(sequence (take (λ$1:e {TEA})) (put it "stool"))'),
    ],
)
def test_other_actions_for_the_same_errand_are_the_same_plan(one, other):
    assert same_plan(task_plan(one), task_plan(other))


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (f"(bring (λ$1:e {TEA} {IN_ATTIC}))", f'(bring (λ$1:e {TEA} (at $1 "stool")))'),
        (f"(bring (λ$1:e {TEA} {IN_ATTIC}))", f"(take (λ$1:e {TEA} {IN_ATTIC}))"),
        (
            f"(sequence (take (λ$1:e {TEA})) (bring it))",
            f'(sequence (take (λ$1:e {TEA})) (bring (λ$1:e (is_a $1 "knife"))))',
        ),
        (
            f'(sequence (find (λ$1:e (person $1) {IN_ATTIC})) (go "stool") (follow them))',
            f'(sequence (find (λ$1:e (person $1) {IN_ATTIC})) (go "stool") (follow (λ$1:e (person $1))))',
        ),
        ('(go "attic")', '(go "stool")'),
        ('(fly "attic")', '(swim "attic")'),
        ("UNKNOWN", "(bring UNKNOWN)"),
    ],
)
def test_another_errand_is_another_plan(one, other):
    assert not same_plan(task_plan(one), task_plan(other))


@given(commands())
def test_a_plan_is_the_same_as_itself_and_as_one_with_other_variables(text):
    plan = task_plan(text)
    assert same_plan(plan, task_plan(text.replace("$1", "$9")))
    assert hash(plan_key(plan)) == hash(plan_key(task_plan(text)))
