"""Slices have names that nobody else's has."""

from __future__ import annotations

import pytest

from annotations.language.texts.errors import LanguageError
from parser_service.results.saving import delete_slice, rename_slice, save_slice


def test_a_slice_keeps_its_query_in_one_order(sample, annotator):
    saved = save_slice(sample.world, "  long   ones ", "min_words=9&part=test&head=go", annotator)
    assert (saved.name, saved.query, saved.created_by) == (
        "long ones",
        "head=go&min_words=9",
        annotator,
    )


@pytest.mark.parametrize("query", ["", "part=test", "outcome=splendid", "nonsense"])
def test_a_slice_of_everything_is_refused(query, sample):
    with pytest.raises(LanguageError):
        save_slice(sample.world, "all", query)
    assert not sample.world.slices.exists()


@pytest.mark.parametrize(("name", "said"), [("", None), (" \0", None), ("x" * 81, "80")])
def test_a_name_that_cannot_be_had_is_refused(name, said, sample):
    with pytest.raises(LanguageError, match=said):
        save_slice(sample.world, name, "outcome=wrong")


def test_two_slices_of_a_world_differ_in_their_names(sample, other_world):
    saved = save_slice(sample.world, "errors", "outcome=wrong")
    save_slice(other_world, "errors", "outcome=wrong")
    other = save_slice(sample.world, "right ones", "outcome=correct")
    with pytest.raises(LanguageError, match="“errors”"):
        save_slice(sample.world, "errors", "outcome=none")
    with pytest.raises(LanguageError, match="“errors”"):
        rename_slice(other, "errors")
    rename_slice(saved, "mistakes")
    saved.refresh_from_db()
    assert saved.name == "mistakes"


def test_a_category_outlives_its_slice(varied):
    saved = save_slice(varied.world, "errors", "outcome=wrong")
    category = varied.world.error_categories.get()
    category.slice = saved
    category.save()
    delete_slice(saved)
    category.refresh_from_db()
    assert category.slice is None
