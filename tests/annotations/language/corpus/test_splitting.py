from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import (
    Criterion,
    FrozenExample,
    SplitItem,
    content_hash,
    read_pairs,
    split,
)
from annotations.language.corpus.splitting import Part
from annotations.language.texts.errors import LanguageError
from tests.annotations.language.published import SHARED, needs_corpus

ITEMS = st.lists(
    st.builds(
        SplitItem,
        st.sampled_from(["generated", "paraphrased"]),
        st.integers(0, 60).map("utterance {}".format),
        st.integers(0, 20).map("command {}".format),
        st.integers(0, 12).map("form {}".format),
    ),
    min_size=1,
    max_size=80,
)
CRITERIA = st.sampled_from(Criterion)


def parts_by_key(
    items: list[SplitItem], parts: tuple[Part, ...], criterion: Criterion
) -> dict[str, set[Part]]:
    parts_of_key: defaultdict[str, set[Part]] = defaultdict(set)
    for item, part in zip(items, parts, strict=True):
        parts_of_key[getattr(item, {"command": "utterance"}.get(criterion, criterion))].add(part)
    return parts_of_key


@given(ITEMS, CRITERIA, st.integers())
def test_no_command_source_command_or_form_is_in_two_parts(
    items: list[SplitItem], criterion: Criterion, seed: int
) -> None:
    parts = split(items, criterion, seed=seed)
    assert len(parts) == len(items)
    assert all(
        len(parts_of_key) == 1 for parts_of_key in parts_by_key(items, parts, criterion).values()
    )


@given(ITEMS, CRITERIA, st.integers())
def test_every_part_gets_something_where_there_is_enough(
    items: list[SplitItem], criterion: Criterion, seed: int
) -> None:
    keys = {item.key(criterion) for item in items}
    parts = split(items, criterion, seed=seed)
    assert len(set(parts)) == min(3, len(keys))


@given(ITEMS, CRITERIA, st.integers(0, 3))
def test_a_split_depends_on_the_seed_and_not_on_the_order(
    items: list[SplitItem], criterion: Criterion, seed: int
) -> None:
    there = dict(zip(items, split(items, criterion, seed=seed), strict=True))
    back = dict(zip(items[::-1], split(items[::-1], criterion, seed=seed), strict=True))
    assert there == back


@given(ITEMS, st.integers(0, 3))
def test_the_share_of_a_part_is_wrong_by_two_keys_at_most(
    items: list[SplitItem], seed: int
) -> None:
    items = [replace(item, source="generated") for item in items]
    parts = split(items, Criterion.LOGICAL_FORM, seed=seed)
    largest = max(Counter(item.logical_form for item in items).values())
    counts = Counter(parts)
    for part, share in zip(Part, (0.7, 0.1, 0.2), strict=True):
        assert abs(counts[part] - share * len(items)) <= 2 * largest + 1


def test_parts_of_both_sources_are_synchronised() -> None:
    items = [
        SplitItem(source, f"{source} {number}", f"command {number % 40}", f"form {number % 20}")
        for number in range(200)
        for source in ("generated", "paraphrased")
    ]
    for criterion in (Criterion.SOURCE_COMMAND, Criterion.LOGICAL_FORM):
        by_source: defaultdict[str, dict[str, Part]] = defaultdict(dict)
        for item, part in zip(items, split(items, criterion, seed=7), strict=True):
            by_source[item.source][item.key(criterion)] = part
        assert by_source["generated"] == by_source["paraphrased"]


def test_another_seed_gives_another_split() -> None:
    items = [SplitItem("generated", f"go {number}", "", "f") for number in range(100)]
    splits = {split(items, Criterion.COMMAND, seed=seed) for seed in range(5)}
    assert len(splits) == 5
    assert Counter(splits.pop()) == {Part.TRAIN: 70, Part.VALIDATION: 10, Part.TEST: 20}


def test_case_and_spacing_do_not_make_another_command() -> None:
    item = SplitItem("paraphrased", "Go  to the attic", "", "f")
    assert item.key(Criterion.COMMAND) == replace(item, utterance="go to the attic").key(
        Criterion.COMMAND
    )
    assert item.key(Criterion.SOURCE_COMMAND) == "go to the attic"


def test_a_part_of_no_share_stays_empty() -> None:
    items = [SplitItem("generated", f"go {number}", "", "f") for number in range(10)]
    parts = split(items, Criterion.COMMAND, (0.8, 0.2, 0.0))
    assert Counter(parts) == {Part.TRAIN: 8, Part.VALIDATION: 2}


@pytest.mark.parametrize(
    ("proportions", "wrong"),
    [((0.7, 0.3), r"\b2\b"), ((0.7, 0.2, 0.2), "110 %"), ((1.2, -0.1, -0.1), "-10 %")],
)
def test_proportions_that_are_no_shares_are_refused_in_percent(
    proportions: tuple[float, ...], wrong: str
) -> None:
    with pytest.raises(LanguageError, match=wrong):
        split([SplitItem("generated", "go", "", "f")], Criterion.COMMAND, proportions)


def test_nothing_cannot_be_split() -> None:
    with pytest.raises(LanguageError):
        split([], Criterion.COMMAND)


EXAMPLE = FrozenExample("train", "generated", "go", "go", "1", "( go 1 )")


def test_the_hash_sees_every_text_and_the_order() -> None:
    other = replace(EXAMPLE, utterance="walk")
    hashes = {content_hash([EXAMPLE, other]), content_hash([other, EXAMPLE]), content_hash([])}
    for name in ("part", "source", "utterance", "source_command", "task_category", "grounded_form"):
        hashes.add(content_hash([replace(EXAMPLE, **{name: "é"}), other]))
    assert len(hashes) == 9
    assert content_hash([EXAMPLE]) == content_hash(iter([EXAMPLE]))
    assert len(content_hash([])) == 64


@needs_corpus
@pytest.mark.parametrize("criterion", Criterion)
def test_the_published_corpus_is_split_near_the_proportions(criterion: Criterion) -> None:
    items = [
        SplitItem(source, pair.utterance, "", pair.canonical_form)
        for folder, source in (("gen", "generated"), ("para", "paraphrased"))
        for file in ("train.txt", "val.txt")
        for pair in read_pairs((SHARED / "walker2019" / folder / file).read_bytes(), file).records
    ]
    parts = split(items, criterion, seed=1)
    for source in ("generated", "paraphrased"):
        mine = [part for item, part in zip(items, parts, strict=True) if item.source == source]
        for part, share in zip(Part, (0.7, 0.1, 0.2), strict=True):
            assert mine.count(part) / len(mine) == pytest.approx(share, abs=0.03)
