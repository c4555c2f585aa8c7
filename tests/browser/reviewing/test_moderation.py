"""Submissions are moderated by keys, the same as those of the review page."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect

from annotations.campaigns.answering import save_answer
from annotations.campaigns.tasks import begin
from annotations.models import Submission
from tests.launched_campaigns import small_campaign

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

READING = 300  # milliseconds: a decision that comes sooner is about the page before


@pytest.fixture
def rows(world) -> list[Submission]:
    contributor = begin(small_campaign(world), "f00d")
    for place in contributor.submissions.all():
        save_answer(place, f"do something new today, number {place.position}", 30)
    return list(contributor.submissions.order_by("pk"))


def statuses() -> list[str]:
    return list(Submission.objects.order_by("pk").values_list("status", flat=True))


def press(page: Page, key: str, row: Submission) -> None:
    """Press a key once the page can have been read, and wait for the page of ``row``."""
    page.wait_for_timeout(READING)
    page.keyboard.press(key)
    expect(page.locator("h1 .count")).to_have_text(str(row.pk))


def test_one_moderates_without_a_mouse(rows, page_of, reviewer, live_server):
    page = page_of(reviewer)
    page.goto(f"{live_server.url}/w/home/submissions/{rows[0].pk}/")
    press(page, "j", rows[1])
    press(page, "k", rows[0])
    press(page, "a", rows[1])
    assert statuses() == ["accepted", "pending", "pending"]
    press(page, "r", rows[2])
    assert statuses() == ["accepted", "rejected", "pending"]
    page.wait_for_timeout(READING)
    page.keyboard.press("z")
    expect(page).to_have_url(f"{live_server.url}/w/home/submissions/?status=pending")
    assert statuses() == ["accepted", "pending", "pending"]


def test_a_key_leads_to_the_text_that_is_mended(rows, page_of, reviewer, live_server):
    page = page_of(reviewer)
    page.goto(f"{live_server.url}/w/home/submissions/{rows[0].pk}/")
    page.keyboard.press("m")
    expect(page.get_by_label("Mend a typing error")).to_be_focused()


def test_a_decision_that_comes_too_soon_is_not_taken_and_that_is_said(
    rows, page_of, reviewer, live_server
):
    page = page_of(reviewer)
    page.clock.install()
    page.goto(f"{live_server.url}/w/home/submissions/{rows[0].pk}/")
    page.keyboard.press("a")
    expect(page.locator("[data-key-ignored]")).not_to_be_empty()
    assert statuses() == ["pending"] * 3
