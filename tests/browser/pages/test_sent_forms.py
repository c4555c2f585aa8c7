"""A form is sent once, however often its button is pressed, and again by whoever goes back to it."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, Page, Route, expect

# What a browser tells a page that it has kept and shows again. The headless shell keeps none
# ("BackForwardCacheDisabledForDelegate"), so the test says it in its place.
SHOWN_AGAIN = "window.dispatchEvent(new PageTransitionEvent('pageshow', {persisted: true}))"


@pytest.fixture
def page(page_of, sample, annotator, live_server) -> Page:
    """The form that freezes a split, on a page that stays when it is sent."""
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/splits/new/")
    return page


@pytest.fixture
def sent(page) -> list[str | None]:
    """What is sent, as it comes."""
    bodies: list[str | None] = []

    def answer(route: Route) -> None:
        bodies.append(route.request.post_data)
        route.fulfill(status=204)  # to which a browser does nothing

    page.route("**/splits/new/", answer)
    return bodies


@pytest.fixture
def button(page) -> Locator:
    return page.get_by_role("button", name="Freeze")


def test_two_presses_send_one_form(page, sent, button):
    button.dblclick()
    expect(button).to_be_disabled()
    expect(page.locator("form[aria-busy=true]")).to_have_count(1)
    button.click(force=True)
    page.get_by_label("Name").press("Enter")
    expect(button).to_be_disabled()
    assert len(sent) == 1 and "freeze=1" in sent[0]


def test_whoever_goes_back_sends_again(page, sent, button):
    button.click()
    expect(button).to_be_disabled()
    page.evaluate(SHOWN_AGAIN)
    expect(button).to_be_enabled()
    expect(page.locator("form[aria-busy]")).to_have_count(0)
    button.click()
    expect(button).to_be_disabled()
    assert len(sent) == 2
