"""How often categories are proposed and given, and how well reviewers agree."""

from __future__ import annotations

import pytest

from annotations.background.progress import UNWATCHED
from parser_service.reviews.category_counts import agreement_of_reviewers, count_categories
from parser_service.reviews.category_proposals import propose_for_run
from parser_service.reviews.tagging import tag
from tests.sample_world import scored_run


def counts_of(run, only=None) -> dict[str, tuple[int, int, int, int]]:
    rows = count_categories(run.world, list(run.world.error_categories.all()), only)
    return {
        row.category.code: (row.proposed, row.tagged, row.accepted, row.judged)
        for row in rows
        if row.proposed or row.tagged
    }


def examples_of(run):
    return [row.example for row in run.predictions.filter(is_exact_match=False)]


def test_tags_are_compared_with_the_proposal(run, categories, reviewer, admin):
    first, second, *_ = examples_of(run)
    tag(run, first, categories["wrong_predicate"], reviewer)
    tag(run, second, categories["wrong_predicate"], reviewer)
    tag(run, second, categories["ill_formed"], admin)
    assert counts_of(run) == {"wrong_predicate": (9, 2, 2, 3), "ill_formed": (0, 1, 0, 0)}


def test_a_share_of_nothing_is_none(run):
    (row, *_) = count_categories(run.world, list(run.world.error_categories.all()))
    assert row.accepted_share is None


def test_counts_are_of_one_run_or_of_all_of_the_world(run, other_sample):
    later = scored_run(run.world, run.split, right=5, seed=1)
    for each in (later, other_sample.run):
        propose_for_run(each, frozenset(), UNWATCHED)
    assert counts_of(run)["wrong_predicate"][0] == 9 + 7
    assert counts_of(run, later)["wrong_predicate"][0] == 7


def test_agreement_is_over_answers_that_two_people_have_tagged(run, categories, reviewer, admin):
    assert agreement_of_reviewers(run.world).items == 0
    for number, example in enumerate(examples_of(run)):
        tag(run, example, categories["wrong_predicate"], reviewer)
        if number < 8:
            code = "wrong_predicate" if number < 6 else "ill_formed"
            tag(run, example, categories[code], admin)
    agreement = agreement_of_reviewers(run.world)
    assert agreement.items == 8 and agreement.exact_match.value == pytest.approx(0.75)
    low, high = agreement.exact_match.interval
    assert 0 < low < 0.75 < high < 1
    assert agreement.ac1.value < 0.75


def test_reviewers_whose_accounts_are_gone_still_count(run, categories, reviewer, admin):
    example = examples_of(run)[0]
    tag(run, example, categories["ill_formed"], reviewer)
    tag(run, example, categories["ill_formed"], admin)
    reviewer.delete()
    admin.delete()
    assert agreement_of_reviewers(run.world).items == 1
