"""Which pairs are held out together."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from annotations.language.corpus.label_errors import LabelledPair, assign_folds, source_key
from annotations.language.texts.errors import Refusal

PAIRS = st.lists(st.sampled_from([f"go to {number}" for number in range(12)]), max_size=40)


def pairs_of(sources):
    return [
        LabelledPair(str(place), f"say {place}", "", source) for place, source in enumerate(sources)
    ]


@given(PAIRS, st.integers(2, 6), st.integers(0, 3))
def test_each_source_command_is_in_one_fold_and_every_fold_has_one(sources, count, seed):
    assume(len(set(sources)) >= count)
    pairs = pairs_of(sources)
    folds = assign_folds(pairs, count, seed)
    assert set(folds) == {source_key(pair) for pair in pairs}
    assert set(folds.values()) == set(range(count))
    sizes = Counter(folds[source_key(pair)] for pair in pairs)
    assert max(sizes.values()) - min(sizes.values()) <= max(Counter(sources).values())
    assert assign_folds(pairs[::-1], count, seed) == folds


def test_case_and_spacing_of_a_source_command_have_no_effect():
    same = pairs_of(["Go  there", "go there"])
    assert source_key(same[0]) == source_key(same[1])
    assert source_key(LabelledPair("a", "Leave", "")) == "leave"


@pytest.mark.parametrize(
    "count, code",
    [(1, "folds_out_of_range"), (21, "folds_out_of_range"), (3, "too_few_commands")],
)
def test_folds_that_cannot_be_made_are_refused(count, code):
    with pytest.raises(Refusal, match=rf"\b{count}\b") as refused:
        assign_folds(pairs_of(["go", "stay"]), count)
    assert refused.value.code == code
