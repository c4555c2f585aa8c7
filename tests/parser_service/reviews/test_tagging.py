"""Tags and notes of reviewers."""

from __future__ import annotations

import pytest

from annotations.language.texts.errors import Refusal
from parser_service.models import Review
from parser_service.reviews.tagging import LONGEST_NOTE, accept, tag, take_back_review, write_note
from parser_service.reviews.world_categories import ensure_categories


def test_a_tag_keeps_the_answer_that_was_read(run, wrong, categories, reviewer):
    review = tag(run, wrong, categories["ill_formed"], reviewer)
    assert (review.reviewer, review.category.code) == (reviewer, "ill_formed")
    assert review.answer == run.predictions.get(example=wrong).logical_form
    assert not review.is_proposed


def test_another_tag_replaces_the_one_before_and_keeps_the_note(run, wrong, categories, reviewer):
    tag(run, wrong, categories["ill_formed"], reviewer)
    write_note(run, wrong, "  Odd.  ", reviewer)
    tag(run, wrong, categories["wrong_predicate"], reviewer)
    review = run.reviews.by_people().get()
    assert (review.category.code, review.note) == ("wrong_predicate", "Odd.")


def test_two_reviewers_tag_one_answer(run, wrong, categories, reviewer, admin):
    tag(run, wrong, categories["ill_formed"], reviewer)
    tag(run, wrong, categories["wrong_predicate"], admin)
    assert run.reviews.by_people().filter(example=wrong).count() == 2
    assert run.reviews.proposed().filter(example=wrong).count() == 1


def test_accepting_tags_with_what_is_proposed(run, wrong, reviewer):
    proposal = run.reviews.proposed().get(example=wrong)
    assert accept(run, wrong, reviewer).category == proposal.category
    proposal.delete()
    with pytest.raises(Refusal) as refused:
        accept(run, wrong, reviewer)
    assert refused.value.code == "no_proposal"


def test_a_right_answer_is_not_tagged_but_may_have_a_note(run, right, categories, reviewer):
    with pytest.raises(Refusal) as refused:
        tag(run, right, categories["ill_formed"], reviewer)
    assert refused.value.code == "answer_is_right"
    assert write_note(run, right, "By luck.", reviewer).category is None


def test_an_example_that_the_run_was_not_asked_about_is_refused(run, categories, reviewer):
    other = run.split.examples.filter(part="train").first()
    with pytest.raises(Refusal) as refused:
        tag(run, other, categories["ill_formed"], reviewer)
    assert refused.value.code == "no_answer"


def test_a_category_of_another_world_is_refused(run, wrong, other_world, reviewer):
    foreign = ensure_categories(other_world)["ill_formed"]
    with pytest.raises(Refusal) as refused:
        tag(run, wrong, foreign, reviewer)
    assert refused.value.code == "category_of_another_world"


def test_taking_back_leaves_the_note_alone(run, wrong, categories, reviewer):
    tag(run, wrong, categories["ill_formed"], reviewer)
    assert take_back_review(run, wrong, reviewer) is None
    assert not run.reviews.by_people().exists()
    tag(run, wrong, categories["ill_formed"], reviewer)
    write_note(run, wrong, "Odd.", reviewer)
    assert take_back_review(run, wrong, reviewer).note == "Odd."
    with pytest.raises(Refusal) as refused:
        take_back_review(run, wrong, reviewer)
    assert refused.value.code == "not_tagged"


def test_nobody_takes_back_what_somebody_else_says(run, wrong, categories, reviewer, admin):
    tag(run, wrong, categories["ill_formed"], reviewer)
    with pytest.raises(Refusal) as refused:
        take_back_review(run, wrong, admin)
    assert refused.value.code == "not_tagged"


def test_an_empty_note_is_removed(run, wrong, reviewer):
    write_note(run, wrong, "Odd.", reviewer)
    assert write_note(run, wrong, " \0 ", reviewer) is None
    assert not run.reviews.by_people().exists()


def test_a_note_has_a_limit(run, wrong, reviewer):
    with pytest.raises(Refusal, match="2,001") as refused:
        write_note(run, wrong, "a" * (LONGEST_NOTE + 1), reviewer)
    assert refused.value.code == "note_too_long"


def test_reviews_stay_when_the_account_goes(run, wrong, categories, reviewer):
    tag(run, wrong, categories["ill_formed"], reviewer)
    reviewer.delete()
    review = Review.objects.by_people().get()
    assert review.reviewer is None and review.category.code == "ill_formed"
