"""How often a parser is right."""

from __future__ import annotations

import pytest

from parser_service.analysis.outcomes import interval_of_outcomes, outcomes_of
from parser_service.analysis.scores import NO_ANSWER, Judgement, judge, score

GOLD = '( find ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'


@pytest.mark.parametrize(
    ("answer", "judgement"),
    [
        (GOLD, Judgement(True, True, True)),
        (GOLD.replace("$1", "$7"), Judgement(True, True, True)),
        (GOLD.replace(" ", "  "), Judgement(True, True, True)),
        (
            '( find ( lambda $1 e ( at $1 " <room> " ) ( is_a $1 " <object> " ) ) )',
            Judgement(False, True, True),
        ),
        ('( find ( lambda $1 e ( is_a $1 " <object> " ) ) )', Judgement(False, False, True)),
        ('( find ( lambda $1 e ( is_a $2 " <object> " ) ) )', NO_ANSWER),
        ("( find ( lambda", NO_ANSWER),
        ("", NO_ANSWER),
    ],
)
def test_an_answer_is_exact_equivalent_well_formed_or_nothing(answer, judgement):
    assert judge(answer, GOLD) == judgement


def test_a_score_counts_exact_matches():
    exact, equal, wrong = Judgement(True, True, True), Judgement(False, True, True), NO_ANSWER
    result = score([exact, equal, wrong, wrong])
    assert (result.count, result.correct, result.accuracy) == (4, 1, 0.25)
    assert (result.equivalent, result.well_formed) == (0.5, 0.5)
    assert result.same_plan is None


def test_plans_are_counted_where_all_were_compared():
    by_plan = Judgement(False, False, True, True)
    exact, wrong = Judgement(True, True, True, True), Judgement(False, False, True, False)
    assert score([exact, by_plan, wrong, wrong]).same_plan == 0.5
    assert score([exact, by_plan, Judgement(False, False, True)]).same_plan is None
    outcomes = outcomes_of(["a", "a", "b"], [exact, by_plan, wrong])
    assert sorted(outcomes.values()) == [[1, 0, 0, 1, 0], [2, 1, 1, 2, 2]]
    low, high = interval_of_outcomes(outcomes, "same_plan")
    assert low <= 2 / 3 <= high
    older = outcomes_of(["a", "b"], [exact, Judgement(True, True, True)])
    assert {len(counts) for counts in older.values()} == {4}
    assert interval_of_outcomes(older, "same_plan") is None


def test_nothing_cannot_be_scored():
    with pytest.raises(ValueError):
        score([])
