"""Reviews survive retraining."""

from __future__ import annotations

import pytest

from annotations.background.progress import UNWATCHED
from parser_service.reviews.category_proposals import propose_for_run
from parser_service.reviews.earlier import (
    history_of_errors,
    new_errors,
    tagged_before,
    tags_of_example_before,
)
from parser_service.reviews.tagging import tag
from tests.parser_service.made_up import make_split
from tests.sample_world import scored_run


@pytest.fixture
def later(run, wrong, categories, reviewer):
    """A run of the same parser on a new split, after somebody has tagged one error of the first."""
    tag(run, wrong, categories["wrong_predicate"], reviewer)
    retrained = scored_run(run.world, make_split(run.world, "newer"), right=2)
    propose_for_run(retrained, frozenset(), UNWATCHED)
    return retrained


def errors_of(run):
    return run.predictions.best().filter(is_exact_match=False)


def test_the_same_utterance_and_label_was_tagged_before(later, wrong):
    (found,) = tagged_before(errors_of(later), later)
    assert found.example != wrong and found.example.utterance == wrong.utterance
    (review,) = tags_of_example_before(later, found.example)
    assert review.example == wrong and review.answer == found.logical_form


def test_another_label_is_another_matter(later):
    (found,) = tagged_before(errors_of(later), later)
    later.split.examples.filter(pk=found.example_id).update(logical_form="( follow UNKNOWN )")
    found.example.refresh_from_db()
    assert not tagged_before(errors_of(later), later).exists()
    assert tags_of_example_before(later, found.example) == []


def test_what_is_tagged_later_is_not_before(later, run, categories, reviewer):
    assert not tagged_before(errors_of(run), run).exists()


def test_new_errors_are_those_that_were_right_before(later, run):
    (new,) = new_errors(errors_of(later), later)
    texts = {"example__utterance": new.example.utterance}
    assert run.predictions.filter(**texts, is_exact_match=True).exists()


def test_the_run_says_how_many(later, run):
    history = history_of_errors(later)
    assert (history.errors, history.tagged_before, history.new) == (10, 1, 1)
    first = history_of_errors(run)
    assert (first.errors, first.tagged_before, first.new) == (9, 0, None)


def test_tags_of_another_world_do_not_count(later, other_sample, reviewer):
    other = other_sample.run
    later.reviews.model.objects.filter(reviewer=reviewer).update(run=other)
    assert not tagged_before(errors_of(later), later).exists()
