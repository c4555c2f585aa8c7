"""Shares of the training items."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import Criterion, SplitItem, draw_share
from annotations.language.texts.errors import Refusal

TEXTS = st.sampled_from(["go", "Go", "find it", "bring it", "take it", ""])
ITEMS = st.lists(
    st.builds(SplitItem, st.sampled_from(["generated", "paraphrased"]), TEXTS, TEXTS, TEXTS),
    min_size=1,
    max_size=40,
)
SHARES = st.floats(0.01, 1)


@given(ITEMS, st.sampled_from(Criterion), SHARES, SHARES, st.integers(0, 5))
def test_a_smaller_share_is_part_of_every_larger_one(items, criterion, one, other, seed):
    small, large = (draw_share(items, criterion, share, seed) for share in sorted([one, other]))
    assert all(
        is_in_large for is_in_small, is_in_large in zip(small, large, strict=True) if is_in_small
    )


@given(ITEMS, st.sampled_from(Criterion), SHARES, st.integers(0, 5))
def test_what_belongs_together_is_drawn_together_and_it_is_enough(items, criterion, share, seed):
    drawn = draw_share(items, criterion, share, seed)
    keys = {item.key(criterion) for item, is_in in zip(items, drawn, strict=True) if is_in}
    assert drawn == tuple(item.key(criterion) in keys for item in items)
    assert sum(drawn) >= share * len(items) - 1e-6
    assert drawn == draw_share(items, criterion, share, seed)


@given(ITEMS, st.sampled_from(Criterion))
def test_all_is_all(items, criterion):
    assert all(draw_share(items, criterion, 1.0))


def test_no_more_keys_are_drawn_than_are_needed():
    items = [SplitItem("generated", f"go {number}", "", "( go )") for number in range(40)]
    assert sum(draw_share(items, Criterion.COMMAND, 0.25)) == 10
    assert sum(draw_share(items, Criterion.LOGICAL_FORM, 0.25)) == 40


def test_another_seed_draws_others():
    items = [SplitItem("generated", f"go {number}", "", "( go )") for number in range(40)]
    drawn = [draw_share(items, Criterion.COMMAND, 0.25, seed) for seed in (0, 1)]
    assert drawn[0] != drawn[1]


@pytest.mark.parametrize("share", [0, -0.5, 1.5])
def test_a_share_of_nothing_or_more_than_all_is_refused(share):
    with pytest.raises(Refusal, match=f"{share:g}") as refused:
        draw_share([], Criterion.COMMAND, share)
    assert refused.value.code == "share_out_of_range"
