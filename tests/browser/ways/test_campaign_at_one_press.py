"""From the commands of a world to a link that people answer, by keys alone: one button, and the steps lead on."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.browser.arriving import arrive, arrive_at
from tests.browser.walking import tab_to
from tests.launched_campaigns import fill_household

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.mark.parametrize("path, title", [("", "Overview"), ("commands/", "Commands")])
def test_one_press_shows_the_link_and_the_steps_lead_on(
    path, title, superuser, logged_in, live_server, world
):
    fill_household(world)
    page = logged_in(superuser).new_page()
    page.goto(f"{live_server.url}/w/home/{path}")
    arrive(page, title)
    tab_to(page, page.get_by_role("button", name="Make a campaign"))
    page.keyboard.press("Enter")
    arrive_at(page, page.locator("#campaign-link"))
    link = page.locator("#campaign-link").input_value()
    assert world.campaigns.get().key in link

    visitor = logged_in(None).new_page()
    visitor.goto(link)
    expect(visitor.get_by_role("button").first).to_be_visible()

    page.goto(f"{live_server.url}/w/home/")
    arrive(page, "Overview")
    expect(page.get_by_role("button", name="Make a campaign")).to_have_count(0)
    page.locator(".first-steps").get_by_role("button", name="Show the link").focus()
    page.keyboard.press("Enter")
    arrive(page, "Campaigns")
