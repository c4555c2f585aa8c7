"""The error categories that a world begins with."""

from __future__ import annotations

from parser_service.analysis.error_categories import DESCRIPTIONS, NAMES
from parser_service.analysis.error_categories import ErrorCategory as Code
from parser_service.models import ErrorCategory
from parser_service.reviews.world_categories import ensure_categories


def test_every_code_has_a_name_and_a_description_that_fit_their_columns():
    assert set(NAMES) == set(DESCRIPTIONS) == set(Code)
    for column, texts in (
        ("name", NAMES),
        ("description", DESCRIPTIONS),
        ("code", dict.fromkeys(Code)),
    ):
        longest = ErrorCategory._meta.get_field(column).max_length
        assert all(len(text or code) <= longest for code, text in texts.items())


def test_a_world_begins_with_the_eleven_in_order(world):
    categories = ensure_categories(world)
    assert list(categories) == [code.value for code in Code]
    assert categories["ill_formed"].name == "Ill-formed"
    assert list(world.error_categories.values_list("position", flat=True)) == list(range(11))


def test_a_second_call_makes_nothing(world):
    first = ensure_categories(world)
    assert ensure_categories(world) == first


def test_what_an_admin_has_changed_and_deleted_stays_so(world):
    categories = ensure_categories(world)
    categories["ill_formed"].delete()
    ErrorCategory.objects.filter(code="wrong_predicate").update(name="Wrong verb")
    again = ensure_categories(world)
    assert len(again) == 10 and again["wrong_predicate"].name == "Wrong verb"


def test_worlds_have_their_own(world, other_world):
    ensure_categories(world)
    assert not other_world.error_categories.exists()
