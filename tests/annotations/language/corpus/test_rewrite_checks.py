from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import Named, RewriteFault, check_rewrite, lost_entities

PROMPT = "bring me the apple from the kitchen table"


@pytest.mark.parametrize(
    ("rewrite", "codes"),
    [
        ("", []),
        ("   ", []),
        (PROMPT, ["too_close"]),
        ("bring me an apple from the kitchen table", ["too_close"]),
        ("could you fetch the apple off the kitchen table", []),
        ("could you fetch the apple", ["lost_entity"]),
        ("x" * 90, ["too_far", "lost_entity", "lost_entity"]),
        ("yes", ["too_far", "lost_entity", "lost_entity"]),
    ],
)
def test_warnings_of_a_rewrite(rewrite: str, codes: list[str]) -> None:
    entities = [Named("apple"), Named("kitchen table")]
    assert [each.code for each in check_rewrite(rewrite, PROMPT, entities)] == codes


@pytest.mark.parametrize(
    "rewrite",
    [
        "the Kitchen Table",
        "kitchen-table",
        "kitchentable",
        "all kitchen tables",
        "the kitchen table's legs",
        "the breakfast place",
    ],
)
def test_a_name_is_known_by_its_spellings_and_aliases(rewrite: str) -> None:
    assert lost_entities(rewrite, [Named("kitchen table", ("breakfast place",))]) == ()


@pytest.mark.parametrize("rewrite", ["kitchen", "table", "kitchen and table", "akitchen table", ""])
def test_a_part_of_a_name_is_no_name(rewrite: str) -> None:
    assert lost_entities(rewrite, [Named("kitchen table")]) == ("kitchen table",)


def test_accents_do_not_matter() -> None:
    assert lost_entities("a cafe for Jose", [Named("café"), Named("José")]) == ()


def test_one_word_of_a_description_is_enough() -> None:
    described = [Named("pointing to the left", is_described=True)]
    assert lost_entities("the person who points left", described) == ()
    assert lost_entities("the person in the hall", described) == ("pointing to the left",)


def test_a_lost_entity_is_named_once() -> None:
    assert lost_entities("go", [Named("bed"), Named("bed"), Named("sofa")]) == ("bed", "sofa")


@given(st.text(max_size=80), st.text(max_size=80), st.lists(st.text(max_size=12), max_size=4))
def test_any_text_can_be_checked(rewrite: str, prompt: str, names: list[str]) -> None:
    warnings = check_rewrite(rewrite, prompt, [Named(name) for name in names])
    of_distance = [each for each in warnings if each.code != RewriteFault.LOST_ENTITY]
    assert len(of_distance) <= 1


@given(st.lists(st.sampled_from(["apple", "tea spoon", "Bo", "living room"]), max_size=4))
def test_a_prompt_keeps_its_own_names(names: list[str]) -> None:
    assert lost_entities(" and ".join(names), [Named(name) for name in names]) == ()
