"""Pairs of known forms, held out of the training part."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import Criterion, SplitItem, harmonic_mean, hold_out_known

SOURCE = Criterion.SOURCE_COMMAND
items = st.lists(
    st.builds(
        SplitItem,
        source=st.sampled_from(["generated", "paraphrased"]),
        utterance=st.sampled_from("abcdefghijklmnop"),
        source_command=st.sampled_from(["", "one", "two", "three", "four", "five"]),
        logical_form=st.sampled_from("XYZ"),
    ),
    max_size=60,
)


@given(items, st.text(max_size=5), st.sampled_from([0.0, 0.1, 0.5, 1.0]))
def test_no_form_loses_its_last_pair_of_a_source(given_items, seed, share):
    held_out = hold_out_known(given_items, seed, share)
    left = {
        (item.source, item.logical_form)
        for item, is_out in zip(given_items, held_out, strict=True)
        if not is_out
    }
    assert left == {(item.source, item.logical_form) for item in given_items}


@given(items, st.text(max_size=5))
def test_a_source_command_goes_as_a_whole(given_items, seed):
    held_out = hold_out_known(given_items, seed, 0.5)
    fate: dict[str, set[bool]] = {}
    for item, is_out in zip(given_items, held_out, strict=True):
        if item.source == "generated" or item.source_command:
            fate.setdefault(item.key(SOURCE), set()).add(is_out)
    assert all(len(fates) == 1 for fates in fate.values())


@given(items, st.randoms(use_true_random=False))
def test_the_order_of_the_items_does_not_matter(given_items, random):
    order = list(range(len(given_items)))
    random.shuffle(order)
    held_out = hold_out_known(given_items, "seed", 0.5)
    shuffled = hold_out_known([given_items[at] for at in order], "seed", 0.5)
    assert [held_out[at] for at in order] == list(shuffled)


def made(number: int) -> list[SplitItem]:
    return [SplitItem("generated", f"command {n}", "", f"form {n % 4}") for n in range(number)] + [
        SplitItem("paraphrased", f"said {n}", f"command {n}", f"form {n % 4}")
        for n in range(number)
    ]


def test_a_tenth_of_the_source_commands_is_held_out_with_their_paraphrases():
    held_out = hold_out_known(made(40), "a")
    assert sum(held_out) == 8
    assert held_out[:40] == held_out[40:]
    assert held_out == hold_out_known(made(40), "a") != hold_out_known(made(40), "b")


def test_a_paraphrase_of_unknown_origin_stays_in_training():
    lost = [SplitItem("paraphrased", f"lost {n}", "", "form 0") for n in range(40)]
    assert not any(hold_out_known([*made(40), *lost], "a", 1.0)[80:])


def test_without_any_origin_each_paraphrase_is_its_own():
    said = [SplitItem("paraphrased", f"said {n}", "", "form") for n in range(20)]
    assert sum(hold_out_known(said, "a")) == 2


@pytest.mark.parametrize(
    ("unseen", "known", "mean"), [(0.5, 0.5, 0.5), (1, 0, 0), (0, 0, 0), (0.4, 0.8, 8 / 15)]
)
def test_the_harmonic_mean_is_nought_where_either_is(unseen, known, mean):
    assert harmonic_mean(unseen, known) == pytest.approx(mean)


def test_what_is_held_out_is_counted_by_form():
    held_out = hold_out_known(made(40), "a", 1.0)
    left = Counter(
        item.logical_form for item, out in zip(made(40), held_out, strict=True) if not out
    )
    assert left == {f"form {n}": 2 for n in range(4)}
