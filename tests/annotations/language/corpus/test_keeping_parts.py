"""Keys that have a part keep it; the others fill what these leave."""

from __future__ import annotations

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import Criterion, Part, SplitItem, split

ITEMS = [SplitItem("generated", f"go {number}", "", "( go )") for number in range(40)]


def test_without_kept_parts_nothing_is_different():
    assert split(ITEMS, Criterion.COMMAND, kept={}) == split(ITEMS, Criterion.COMMAND)


@given(st.dictionaries(st.integers(0, 39), st.sampled_from(list(Part)), max_size=40))
def test_kept_keys_stay_in_their_parts(chosen):
    kept = {f"go {number}": part for number, part in chosen.items()}
    parts = split(ITEMS, Criterion.COMMAND, kept=kept)
    for item, part in zip(ITEMS, parts, strict=True):
        assert kept.get(item.utterance, part) == part


def test_the_others_fill_what_these_leave():
    kept = {item.utterance: Part.TEST for item in ITEMS[:8]}
    sizes = Counter(split(ITEMS, Criterion.COMMAND, kept=kept))
    assert (sizes[Part.TRAIN], sizes[Part.VALIDATION], sizes[Part.TEST]) == (28, 4, 8)


def test_kept_keys_that_no_item_has_do_not_matter():
    parts = split(ITEMS, Criterion.COMMAND, kept={"never said": Part.TEST})
    assert parts == split(ITEMS, Criterion.COMMAND)
