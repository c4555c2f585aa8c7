"""What parts share with training."""

from __future__ import annotations

import pytest

from annotations.language.corpus import Leak, SplitItem, comparisons, near_duplicates, shared
from annotations.language.corpus.leakage import NEAR
from tests.work import steps_of


def item(utterance, source_command="", form="( go )"):
    return SplitItem("paraphrased", utterance, source_command, form)


TRAIN = [
    item("bring me the <object>", "fetch the <object>", "( bring )"),
    item("take the <object> to the <room>", "", "( take )"),
]


def leaks(*items):
    return {leak.what: (leak.shared, leak.pairs) for leak in shared("test", items, TRAIN)}


def test_case_and_spacing_do_not_hide_a_shared_utterance():
    assert leaks(item(" Bring me  the <object>"), item("leave"))["utterances"] == (1, 2)


def test_a_source_command_is_shared_though_the_words_differ():
    counts = leaks(item("give it to me", "Fetch the <object>"), item("leave", "go away"))
    assert counts["source commands"] == (1, 2)
    assert counts["utterances"] == (0, 2)


def test_pairs_without_a_source_command_are_not_counted_among_them():
    assert "source commands" not in leaks(item("take the <object> to the <room>"))


def test_forms_are_shared_by_pair():
    counts = leaks(item("a", form="( take )"), item("b", form="( take )"), item("c"))
    assert counts["logical forms"] == (2, 3)


def test_nothing_is_shared_by_a_part_without_pairs():
    assert leaks() == {}
    assert Leak("test", "utterances", 0, 0).share == 0.0


def test_a_typing_error_is_a_near_duplicate_with_its_neighbour():
    (duplicate,) = near_duplicates("test", [item("Bring me teh <object>")], TRAIN).duplicates
    assert (duplicate.utterance, duplicate.training) == (
        "bring me teh <object>",
        "bring me the <object>",
    )
    assert duplicate.similarity == pytest.approx(1 - 2 / 21)


def test_what_training_has_is_no_near_duplicate():
    assert not near_duplicates("test", [item("BRING me the <object>")], TRAIN).duplicates


def test_the_nearest_of_several_is_named():
    train = [item("go to the big red room"), item("go to the big bad room")]
    (duplicate,) = near_duplicates("test", [item("go to the big bed room")], train).duplicates
    assert duplicate.training == "go to the big bad room"
    assert duplicate.similarity >= NEAR


def test_pairs_are_counted_and_texts_listed_once_the_nearest_first():
    far, near = item("take teh <object> too the <room>"), item("bring me the <object>s")
    nearest = near_duplicates("test", [far, near, near, item("leave")], TRAIN)
    assert (nearest.leak.shared, nearest.leak.pairs) == (3, 4)
    assert [each.utterance for each in nearest.duplicates] == [near.utterance, far.utterance]


def test_no_line_of_python_runs_for_each_comparison():
    train = [
        item(f"bring the {number} apples from the <room> to me please") for number in range(2000)
    ]
    asked = [
        item(f"bring the {number} pears from the <room> to me please") for number in range(600)
    ]
    assert comparisons(asked, train) == 1_200_000
    assert steps_of(lambda: near_duplicates("test", asked, train)) < 50_000
