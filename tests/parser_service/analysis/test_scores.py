import pytest

from parser_service.analysis.scores import NO_ANSWER, Judgement, judge, score, wilson_interval

GOLD = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'


def test_the_annotated_form_itself_is_right():
    assert judge(GOLD, GOLD) == Judgement(True, True, True)


def test_names_of_variables_and_spaces_do_not_matter():
    answer = '(bring (lambda $7 e (is_a $7 " <object> ")(at $7 "<room>")))'
    assert judge(answer, GOLD) == Judgement(True, True, True)


def test_another_order_of_conjuncts_is_equivalent_but_no_exact_match():
    answer = '( bring ( lambda $1 e ( at $1 " <room> " ) ( is_a $1 " <object> " ) ) )'
    assert judge(answer, GOLD) == Judgement(False, True, True)


def test_another_form_is_wrong_but_well_formed():
    assert judge('( go " <room> " )', GOLD) == Judgement(False, False, True)


@pytest.mark.parametrize("answer", ["", "( bring ( lambda $1 e", ") go (", "( is_a $1 )"])
def test_what_is_no_form_is_neither_right_nor_well_formed(answer):
    assert judge(answer, GOLD) == NO_ANSWER


def test_a_score_counts_each_kind():
    judgements = [Judgement(True, True, True), Judgement(False, True, True), NO_ANSWER, NO_ANSWER]
    result = score(judgements)
    assert (result.count, result.correct) == (4, 1)
    assert (result.accuracy, result.equivalent, result.well_formed) == (0.25, 0.5, 0.5)
    assert result.interval == wilson_interval(1, 4)


def test_nothing_to_score_is_refused_with_a_sentence():
    with pytest.raises(ValueError, match="no example to score"):
        score([])


@pytest.mark.parametrize(
    ("correct", "count", "low", "high"),
    [  # values of the closed formula, as tabled for the Wilson score interval
        (0, 10, 0.0, 0.2775),
        (10, 10, 0.7225, 1.0),
        (5, 10, 0.2366, 0.7634),
        (81, 263, 0.2553, 0.3662),
    ],
)
def test_the_interval_is_wilsons(correct, count, low, high):
    assert wilson_interval(correct, count) == pytest.approx((low, high), abs=1e-4)


@pytest.mark.parametrize("count", [1, 2, 181, 100_000])
def test_the_interval_holds_the_share_and_stays_within_zero_and_one(count):
    for correct in {0, 1, count // 2, count}:
        low, high = wilson_interval(correct, count)
        assert 0 <= low <= correct / count <= high <= 1
