from math import log

import pytest

from annotations.language.plans import best_alternative

COSTS = {
    "bring me the bowl": 0.0,
    "uh bring me the cola": -3.0,
    "bring me the bull": -8.0,
    "bring me the coke": 0.0,
}


@pytest.mark.parametrize(
    ("alternatives", "best"),
    [
        ([("bring me the bull", 0.6), ("bring me the bowl", 0.3)], 1),
        ([("uh bring me the cola", 0.9), ("bring me the coke", 0.01)], 0),
        ([("the weather is nice", 0.9), ("bring me the bowl", 0.05)], 1),
        ([("bring me the bowl", 0.5), ("bring me the coke", 0.5)], 0),
        ([("bring me the bull", log(0.6)), ("bring me the bowl", log(0.3))], 1),
        ([("bring me the bowl", 0.0)], 0),
        ([("the weather is nice", 0.9)], None),
        ([], None),
    ],
)
def test_the_likeliest_alternative_that_is_understood_counts(alternatives, best):
    assert best_alternative(alternatives, COSTS.get) == best


def test_each_text_is_judged_once():
    asked = []

    def judge(text):
        asked.append(text)
        return 0.0

    best_alternative([("a", 0.4), ("a", 0.3), ("b", 0.3)], judge)
    assert asked == ["a", "b"]
