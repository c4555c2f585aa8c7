"""What an admin changes about error categories."""

from __future__ import annotations

import pytest

from annotations.language.texts.errors import Refusal
from parser_service.models import ErrorCategory, Slice
from parser_service.reviews.tagging import tag
from parser_service.reviews.world_categories import (
    add_category,
    change_category,
    delete_category,
    ensure_categories,
    move_category,
)


def codes(world) -> list[str]:
    return list(world.error_categories.values_list("code", flat=True))


def test_a_category_is_added_behind_the_others_with_a_code_of_its_own(world, categories):
    added = add_category(world, "Wrong  predicate!", "Of another kind.")
    assert added.code == "wrong_predicate_2" and codes(world)[-1] == added.code
    assert add_category(world, "忘れた").code == "category"


def test_a_name_is_taken_once_whatever_its_case(world, categories):
    with pytest.raises(Refusal) as refused:
        add_category(world, "ILL-FORMED")
    assert refused.value.code == "category_name_taken"
    with pytest.raises(Refusal) as refused:
        change_category(categories["wrong_argument"], "Ill-formed", "", None)
    assert refused.value.code == "category_name_taken"
    change_category(categories["ill_formed"], "ill-formed", "", None)  # its own
    add_category(world, "Ärger")
    with pytest.raises(Refusal) as refused:
        add_category(world, "ärger")
    assert refused.value.code == "category_name_taken"


def test_a_renamed_category_keeps_its_code(world, categories):
    saved = Slice.objects.create(world=world, name="long", query="min_words=9")
    change_category(categories["ill_formed"], "No form", "Not a form.", saved)
    row = ErrorCategory.objects.get(code="ill_formed", world=world)
    assert (row.name, row.description, row.slice) == ("No form", "Not a form.", saved)


def test_categories_change_places(world, categories):
    first, second, *_, last = codes(world)
    move_category(categories[second], -1)
    assert codes(world)[:2] == [second, first]
    move_category(categories[second], -1)
    move_category(categories[last], 1)
    assert (codes(world)[0], codes(world)[-1]) == (second, last)


def test_deletion_moves_the_reviews(run, wrong, categories, reviewer):
    tag(run, wrong, categories["wrong_predicate"], reviewer)
    with pytest.raises(Refusal, match=r"\b10\b") as refused:
        delete_category(categories["wrong_predicate"], None)
    assert refused.value.code == "reviews_need_category"
    with pytest.raises(Refusal) as refused:
        delete_category(categories["wrong_predicate"], categories["wrong_predicate"])
    assert refused.value.code == "reviews_need_category"
    assert delete_category(categories["wrong_predicate"], categories["ill_formed"]) == 10
    assert "wrong_predicate" not in codes(run.world)
    assert categories["ill_formed"].reviews.count() == run.reviews.count() == 10


def test_reviews_do_not_leave_the_world(run, categories, other_world):
    foreign = ensure_categories(other_world)["ill_formed"]
    with pytest.raises(Refusal) as refused:
        delete_category(categories["wrong_predicate"], foreign)
    assert refused.value.code == "category_of_another_world"


def test_one_category_is_left(world, categories):
    *others, last = categories.values()
    for each in others:
        delete_category(each, last)
    with pytest.raises(Refusal) as refused:
        delete_category(last, None)
    assert refused.value.code == "last_error_category"
