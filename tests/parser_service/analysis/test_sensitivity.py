"""What a change of one word does to answers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import wilson_interval
from annotations.language.forms import FormDistances, equivalent, read_form
from parser_service.analysis.sensitivity import (
    ALL_KINDS,
    EditAnswers,
    find_deciding_words,
    measure_sensitivity,
    remove_words,
    single_word,
)

FORMS = [
    '(go "<room>")',
    '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<room>")))',
    '(bring (λ$1:e (at $1 "<room>") (is_a $1 "<object>")))',
    "UNKNOWN",
    "( go",
]
form = st.sampled_from(FORMS)
edits = st.lists(
    st.tuples(st.sampled_from("ab"), st.integers(0, 4), form, form, form, form), min_size=1
)


def answers_of(rows):
    return EditAnswers(*(list(column) for column in zip(*rows, strict=True)))


def same(first, second):
    if "( go" in (first, second):
        return first == second
    return equivalent(read_form(first), read_form(second))


def far(first, second):
    if "( go" in (first, second):
        return float(first != second)
    return FormDistances().distance(read_form(first), read_form(second))


@given(edits)
def test_rows_are_what_one_edit_at_a_time_says(rows):
    result = {row.kind: row for row in measure_sensitivity(answers_of(rows))}
    assert list(result)[-1] == ALL_KINDS
    for kind, row in result.items():
        own = [each for each in rows if kind in (each[0], ALL_KINDS)]
        assert row.edits == len(own)
        assert row.flip_rate == pytest.approx(np.mean([not same(e[2], e[3]) for e in own]))
        assert row.distance == pytest.approx(np.mean([far(e[2], e[3]) for e in own]))
        assert row.label_distance == pytest.approx(np.mean([far(e[4], e[5]) for e in own]))
        bases = {each[1] for each in own}
        consistent = sum(
            all(same(e[2], e[4]) and same(e[3], e[5]) for e in own if e[1] == base)
            for base in bases
        )
        assert row.bases == len(bases)
        assert row.consistency == consistent / len(bases)
        assert row.consistency_interval == wilson_interval(consistent, len(bases))
        for value, (low, high) in (
            (row.flip_rate, row.flip_interval),
            (row.distance, row.distance_interval),
        ):
            assert 0 <= low <= high <= 1
            assert (
                low <= value + 0.5
            )  # an interval of very few utterances may miss the value itself


def test_a_perfect_parser_flips_exactly_where_it_must():
    keep = [("article", n, FORMS[0], FORMS[0], FORMS[0], FORMS[0]) for n in range(20)]
    change = [("place", n, FORMS[0], FORMS[1], FORMS[0], FORMS[2]) for n in range(20)]
    article, place, everything = measure_sensitivity(answers_of(keep + change))
    assert (article.flip_rate, article.distance, article.consistency) == (0, 0, 1)
    assert (place.flip_rate, place.consistency) == (1, 1)
    assert place.distance == place.label_distance
    assert everything.edits == 40
    assert everything.bases == 20
    assert article.flip_interval == wilson_interval(0, 20)


def test_without_edits_there_are_no_rows_and_lists_have_to_be_as_long():
    assert measure_sensitivity(EditAnswers([], [], [], [], [], [])) == ()
    with pytest.raises(ValueError):
        measure_sensitivity(EditAnswers(["a"], [0], [], [], [], []))


VERBS = ["bring", "find", "take"]
THINGS = ["tea", "cup", "lamp", "umbrella"]
PLACES = ["hall", "bath", "yard"]
COMMANDS = [
    f"{verb} the {thing} in the {place}" for verb in VERBS for thing in THINGS for place in PLACES
]


def look_at_one_word(text):
    return "bring" if "umbrella" in text.split() else "go"


def understand(text):
    """Answers by verb, thing and place, as a perfect parser does."""
    return tuple(word for word in text.split() if word != "the")


def decided_by(parser):
    removals = remove_words(COMMANDS)
    answers = [parser(text) for text in COMMANDS]
    changed = np.array(
        [
            parser(text) != answers[base]
            for text, base in zip(removals.texts, removals.bases.tolist(), strict=True)
        ]
    )
    return find_deciding_words(removals.words, changed)


def test_a_parser_that_looks_at_a_single_word_is_reported_with_that_word():
    rows = decided_by(look_at_one_word)
    word = single_word(rows)
    assert word == rows[0]
    assert (word.word, word.trials, word.changes, word.share) == ("umbrella", 9, 9, 1.0)
    assert (word.rate, word.others_rate) == (1.0, 0.0)


@pytest.mark.parametrize("parser", [understand, lambda text: "go"])
def test_a_perfect_parser_and_one_that_looks_at_nothing_are_reported_with_no_word(parser):
    assert single_word(decided_by(parser)) is None


def test_p_and_q_values_are_those_of_scipy():
    from scipy import stats

    rows = decided_by(lambda text: ("umbrella" in text, "bring" in text))
    total = sum(row.changes for row in rows)
    trials = sum(row.trials for row in rows)
    expected = {
        row.word: stats.binomtest(
            row.changes,
            row.trials,
            (total - row.changes + 1) / (trials - row.trials + 2),
            "greater",
        ).pvalue
        for row in rows
    }
    q_values = dict(
        zip(expected, stats.false_discovery_control(list(expected.values())), strict=True)
    )
    for row in rows:
        assert row.p_value == pytest.approx(expected[row.word])
        assert row.q_value == pytest.approx(q_values[row.word])


def test_every_word_is_removed_once():
    removals = remove_words(["Bring the tea", "", "go"])
    assert removals.texts == ("the tea", "Bring tea", "Bring the", "")
    assert removals.words == ("bring", "the", "tea", "go")
    assert removals.bases.tolist() == [0, 0, 0, 2]


def test_nothing_decides_nothing():
    assert find_deciding_words([], np.array([], dtype=bool)) == ()
    assert single_word(()) is None
    with pytest.raises(ValueError, match=r"0 .* 1 "):
        find_deciding_words(["a"], np.array([], dtype=bool))
