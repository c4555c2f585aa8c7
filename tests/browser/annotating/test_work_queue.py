"""Two people label one utterance without seeing each other; a third one settles it by keyboard."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import set_share
from annotations.models import Utterance, WorkKind
from annotations.models.worlds import Role
from tests.browser.arriving import arrive_at
from tests.conftest import member

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_two_blind_labels_and_a_third_person(page_of, live_server, sample, annotator, reviewer):
    queue = f"{live_server.url}/w/home/queue/"
    collect(sample.world, ["find the tea please"], by=annotator)
    set_share(sample.world, WorkKind.UNLABELLED, 100)
    for person, key in ((annotator, "1"), (member(sample.world, "berta", Role.ANNOTATOR), "u")):
        page = page_of(person)
        page.goto(queue)
        page.get_by_role("button", name="Take the next item").press("Enter")
        expect(page.locator("[data-label-page][data-ready]")).to_have_count(1)
        expect(page.get_by_text("neither sees what the other answers")).to_be_visible()
        with page.expect_response("**/answer/"):
            page.keyboard.press(key)
        expect(page.locator("[data-label-done]")).to_be_visible()
        assert Utterance.objects.get(text="find the tea please").status == "unlabelled"

    page = page_of(reviewer)
    page.goto(queue)
    page.get_by_role("button", name="Take the next item").press("Enter")
    arrive_at(page, page.get_by_text("anna and berta gave different answers"))
    page.get_by_label("What anna says").press("Space")
    page.get_by_role("button", name="Settle it").press("Enter")
    expect(page.get_by_text("Settled: find the tea please")).to_be_visible()
    assert Utterance.objects.get(text="find the tea please").status == "labelled"
