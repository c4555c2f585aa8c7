"""Labelling when others are faster, the session ends or the connection is lost."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect

from annotations.labelling import collect, label
from annotations.models import Utterance, Verdict
from tests.browser.conftest import give_window
from tests.waiting import wait_for

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

SAID = ["find the tea now", "find the tea please"]


@pytest.fixture
def label_page(page_of, live_server, sample, annotator) -> Page:
    collect(sample.world, SAID, by=annotator)
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/label/")
    expect(page.locator("[data-label-page][data-ready]")).to_have_count(1)
    return page


def expect_utterance(page: Page, text: str) -> None:
    expect(page.locator("[data-item]")).to_have_attribute(
        "data-item", str(Utterance.objects.get(text=text).pk)
    )


def test_an_answer_to_what_somebody_else_has_answered(label_page, admin):
    page = label_page
    expect_utterance(page, SAID[0])
    label(Utterance.objects.get(text=SAID[0]), Verdict.UNKNOWN, "", admin, 1)
    page.keyboard.press("1")
    expect_utterance(page, SAID[1])
    expect(page.get_by_role("alert")).to_contain_text("adam has changed this utterance")
    page.get_by_role("button", name="Show it").click()
    expect_utterance(page, SAID[0])
    assert Utterance.objects.get(text=SAID[0]).status == "unknown"


def test_answers_outlive_the_session(label_page, live_server, annotator):
    page = label_page
    page.context.clear_cookies()
    page.keyboard.press("1")
    page.wait_for_function(f"localStorage.getItem('answers:{annotator.pk}')?.length > 2")
    give_window(page.context, annotator, live_server.url)
    page.goto(f"{live_server.url}/w/home/label/")
    expect(page.locator(".label-last")).to_contain_text(SAID[0])
    wait_for(Utterance.objects.labelled().filter(text=SAID[0]).exists, "the answer is stored")


def test_answers_without_a_connection_arrive_later(label_page, live_server):
    page = label_page
    page.route("**/answer/", lambda route: route.abort())
    page.keyboard.press("1")
    expect(page.locator("#connection")).to_be_visible()
    page.unroute("**/answer/")
    page.goto(f"{live_server.url}/w/home/label/")
    expect(page.locator(".label-last")).to_contain_text(SAID[0])
    wait_for(Utterance.objects.labelled().filter(text=SAID[0]).exists, "the answer is stored")
