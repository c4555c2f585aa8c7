"""Slices are saved from where one sees them, by reviewers."""

from __future__ import annotations

import pytest

from parser_service.models import Slice
from parser_service.results.saving import save_slice
from tests.notices import levels

PAGE = "/w/home/slices/"


def test_a_reviewer_saves_what_a_list_shows_and_comes_back_to_it(sample, rene):
    listed = f"/w/home/runs/{sample.run.pk}/predictions/?outcome=wrong&part=validation"
    assert 'value="outcome=wrong"' in rene.get(listed).content.decode()
    answer = rene.post(PAGE, {"name": "errors", "query": "outcome=wrong", "next": listed})
    assert answer["Location"] == listed
    saved = Slice.objects.get()
    assert (saved.name, saved.query, saved.created_by.username) == (
        "errors",
        "outcome=wrong",
        "rene",
    )
    page = rene.get(PAGE).content.decode()
    assert "errors" in page and "Outcome</span> wrong" in page


def test_nobody_is_led_to_another_site(sample, rene):
    saved = {"name": "errors", "query": "outcome=wrong", "next": "https://example.org/"}
    assert rene.post(PAGE, saved)["Location"] == PAGE


@pytest.mark.parametrize(
    "posted",
    [{"name": "", "query": "outcome=wrong"}, {"name": "all", "query": "part=test"}, {}],
)
def test_what_cannot_be_saved_is_explained(posted, sample, rene):
    assert levels(rene.post(PAGE, posted, follow=True)) == ["error"]
    assert not Slice.objects.exists()


def test_a_slice_is_renamed_and_keeps_its_address(sample, rene):
    saved = save_slice(sample.world, "errors", "outcome=wrong")
    save_slice(sample.world, "taken", "outcome=none")
    rene.post(f"{PAGE}{saved.pk}/rename/", {"name": "mistakes"})
    saved.refresh_from_db()
    assert saved.name == "mistakes"
    answer = rene.post(f"{PAGE}{saved.pk}/rename/", {"name": "taken"}, follow=True)
    assert levels(answer) == ["error"] and "“taken”" in str(*answer.context["messages"])
    saved.refresh_from_db()
    assert saved.name == "mistakes"


def test_a_deletion_can_be_undone(sample, rene):
    saved = save_slice(sample.world, "errors", "outcome=wrong")
    page = rene.post(f"{PAGE}{saved.pk}/delete/", follow=True)
    assert page.context["deleted"] == {"name": "errors", "query": "outcome=wrong"}
    assert 'name="query" value="outcome=wrong"' in page.content.decode()
    rene.post(PAGE, page.context["deleted"])
    assert Slice.objects.get().query == "outcome=wrong"
    assert rene.get(PAGE).context["deleted"] is None


def test_annotators_look_but_do_not_save(sample, anna):
    save_slice(sample.world, "errors", "outcome=wrong")
    page = anna.get(PAGE).content.decode()
    assert "errors" in page and "/rename/" not in page
    listed = f"/w/home/runs/{sample.run.pk}/predictions/?outcome=wrong"
    assert f'action="{PAGE}"' not in anna.get(listed).content.decode()


def test_a_slice_of_another_world_is_not_found(sample, other_world, rene):
    saved = save_slice(other_world, "theirs", "outcome=wrong")
    assert rene.post(f"{PAGE}{saved.pk}/delete/").status_code == 404
    assert rene.post(f"{PAGE}{saved.pk}/rename/", {"name": "x"}).status_code == 404
