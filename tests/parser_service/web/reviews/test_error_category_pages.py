"""The pages of error categories: everybody reads them, admins change them."""

from __future__ import annotations

import re

import pytest

from annotations.background.progress import UNWATCHED
from parser_service.models import Slice
from parser_service.reviews.category_proposals import propose_for_run
from parser_service.reviews.tagging import tag
from parser_service.reviews.world_categories import ensure_categories

PATH = "/w/home/error-categories/"


@pytest.fixture
def run(sample):
    propose_for_run(sample.run, frozenset(), UNWATCHED)
    return sample.run


def category(run, code="wrong_predicate"):
    return ensure_categories(run.world)[code]


def test_a_new_world_has_the_eleven(world, anna):
    page = anna.get(PATH)
    assert len(page.context["counts"]) == 11
    assert "Ill-formed" in page.content.decode()


def test_counts_lead_to_the_errors_of_a_run(run, anna):
    page = anna.get(PATH).content.decode()
    address = f"/w/home/review/?run={run.pk}&amp;category=wrong_predicate&amp;category_by=machine"
    assert f'href="{address}"' in page
    assert anna.get(address.replace("&amp;", "&")).context["listing"].total == 9


def test_agreement_is_shown_once_two_people_have_tagged(run, anna, reviewer, admin):
    assert "AC1" not in anna.get(PATH).content.decode()
    for row in run.predictions.filter(is_exact_match=False):
        for person in (reviewer, admin):
            tag(run, row.example, category(run), person)
    page = anna.get(PATH).content.decode()
    assert "100 %" in page and "AC1" in page


def test_others_see_no_forms(run, anna, rene):
    for client in (anna, rene):
        for page in (PATH, f"{PATH}{category(run).pk}/"):
            shown = client.get(page).content.decode()
            shown = shown.partition('<main id="main"')[2].partition("</main>")[0]
            assert 'method="post"' not in shown and category(run).name in shown


def test_an_admin_adds_changes_and_orders(run, adam):
    saved = Slice.objects.create(world=run.world, name="long", query="min_words=9")
    adam.post(PATH, {"name": "Too long", "description": "", "slice": saved.pk})
    added = run.world.error_categories.get(code="too_long")
    assert added.slice == saved
    assert adam.post(PATH, {"name": "too long"}).status_code == 422
    adam.post(f"{PATH}{added.pk}/", {"name": "Long", "description": "Over nine words."})
    added.refresh_from_db()
    assert (added.name, added.description, added.slice) == ("Long", "Over nine words.", None)
    adam.post(f"{PATH}{added.pk}/move/", {"step": "up"})
    assert run.world.error_categories.reverse()[1] == added


def test_a_slice_of_another_world_is_none(run, other_world, adam):
    foreign = Slice.objects.create(world=other_world, name="long", query="min_words=9")
    assert adam.post(PATH, {"name": "Long", "slice": foreign.pk}).status_code == 422


def test_deletion_says_how_many_reviews_there_are_and_where_they_go(run, adam):
    row = category(run)
    page = adam.get(f"{PATH}{row.pk}/").content.decode()
    assert re.search(r"\b9 review", page) and 'name="move_to"' in page
    refused = adam.post(f"{PATH}{row.pk}/delete/")
    assert refused.status_code == 422 and 'name="move_to"' in refused.content.decode()
    assert category(run).reviews.count() == 9
    adam.post(f"{PATH}{row.pk}/delete/", {"move_to": category(run, "wrong_structure").pk})
    assert category(run, "wrong_structure").reviews.count() == 9


def test_what_an_admin_writes_is_escaped(run, adam, anna):
    text = "<script>alert(1)</script>"
    adam.post(PATH, {"name": text, "description": text})
    for path in (PATH, f"{PATH}{run.world.error_categories.last().pk}/"):
        assert text not in anna.get(path).content.decode()
