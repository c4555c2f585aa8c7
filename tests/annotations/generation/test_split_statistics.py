"""How much of what a split's validation part asks for its training part has."""

from __future__ import annotations

from importlib import import_module
from json import dumps, loads

import pytest
from django.apps import apps
from hypothesis import given
from hypothesis import strategies as st

from annotations.generation.split_statistics import SplitFigures, figures_of, store_figures
from annotations.language.corpus import FormOverlap, Overlap, overlap_of, together
from annotations.models import Example, Split, World

COUNTS = st.dictionaries(st.sampled_from("abcdefgh"), st.integers(1, 50))


@given(COUNTS, COUNTS)
def test_new_forms_are_those_that_nothing_was_taught_of(asked, taught):
    overlap = overlap_of(asked, taught)
    assert overlap.examples == sum(asked.values())
    assert overlap.new_forms == len(set(asked) - set(taught))
    assert 0 <= overlap.new_form_share <= 1
    assert (overlap.new_form_share == 0) == (set(asked) <= set(taught))


def test_the_larger_of_both_shares_counts():
    few_pairs_of_new_forms = overlap_of({"a": 9, "b": 1}, {"a": 1})
    many = overlap_of({"a": 1, "b": 1, "c": 8}, {"a": 1, "b": 1})
    assert (few_pairs_of_new_forms.new_form_share, many.new_form_share) == (0.5, 0.8)
    assert Overlap().new_form_share == Overlap().new_command_share == 0
    both = together([few_pairs_of_new_forms, many])
    assert (len(both.forms), both.examples, both.examples_of_new_forms) == (5, 20, 9)


@pytest.fixture
def split(world: World) -> Split:
    made = Split.objects.create(world=world, name="s", criterion="command", content_hash="0" * 64)
    rows = [
        ("train", "generated", "go", "go there", "go there"),
        ("train", "generated", "go", "go now", "go now"),
        ("train", "paraphrased", "bring", "fetch it", "bring it"),
        ("validation", "generated", "go", "go back", "go back"),
        ("validation", "generated", "find", "find it", "find it"),
        ("validation", "paraphrased", "bring", "get it", "bring it"),
        ("validation", "paraphrased", "bring", "hand it over", "give it"),
        ("validation", "said", "bring", "i want it", ""),
        ("test", "generated", "say", "say it", "say it"),
    ]
    Example.objects.bulk_create(
        Example(
            split=made,
            position=position,
            part=part,
            source=source,
            logical_form=form,
            utterance=text,
            source_command=command,
        )
        for position, (part, source, form, text, command) in enumerate(rows)
    )
    return made


def test_forms_and_commands_are_counted_by_source(split):
    assert figures_of(split).overlaps == {
        "generated": Overlap((FormOverlap(1, 0), FormOverlap(1, 2))),
        "paraphrased": Overlap((FormOverlap(2, 1),), new_commands=1),
        "said": Overlap((FormOverlap(1, 1),)),
    }


def test_the_share_is_that_of_all_sources_together(split):
    assert figures_of(split).new_form_share == 0.25  # one of four forms, one of five pairs
    split.examples.filter(part="train").delete()
    assert figures_of(split).new_form_share == 1


def test_stored_figures_are_those_that_were_counted(split, django_assert_num_queries):
    counted = figures_of(split)
    store_figures(split)
    stored = Split.objects.get(pk=split.pk)
    with django_assert_num_queries(0):
        assert figures_of(stored) == counted
    assert (counted.counts[0].train, counted.counts[0].forms) == (2, 3)
    assert {leak.part for leak in counted.leaks} == {"validation", "test"}


@given(COUNTS, COUNTS)
def test_figures_come_back_from_json_as_they_were(asked, taught):
    figures = SplitFigures((), (), {"said": overlap_of(asked, taught, 3)})
    assert SplitFigures.from_json(loads(dumps(figures.as_json()))) == figures


def test_an_upgrade_stores_the_figures_of_every_split(split):
    import_module("annotations.migrations.0046_figures_of_splits").store(apps, None)
    stored = Split.objects.get(pk=split.pk)
    assert stored.figures == figures_of(split).as_json() != {}
