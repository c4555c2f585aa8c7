"""The link of a campaign on a phone: from the first page to the code, with scripts, by keyboard, and without."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from annotations.models import Contributor, Submission
from tests.browser.faults import (
    listen,
    narrow_and_dark,
    only_faults,
    wide_and_light,
)
from tests.browser.variants import NARROW_DARK, VARIANTS, WIDE_LIGHT
from tests.browser.walking import tab_to
from tests.launched_campaigns import small_campaign

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

NARROW_LIGHT = VARIANTS[2]
# What people say for the prompts of the small campaign: right, and with the entity lost.
SAID = {
    "bring me the apple from the kitchen table": "fetch an apple that lies on the table in the kitchen",
    "tell me how many people are in the living room": "count the persons who sit in the living room",
}
CLOSE = "This is almost what it was. Can you say it in your own words?"
FAR = "This is very different. Does it still ask for the same?"


@pytest.fixture
def link(transactional_db, world, live_server) -> str:
    campaign = small_campaign(
        world, completion_code="C0FFEE", return_url=f"{live_server.url}/healthz", examples="- *go*"
    )
    return f"{live_server.url}/p/{campaign.key}/"


def agree(page: Page, link: str) -> None:
    page.goto(link)
    page.get_by_label("I agree").check()
    page.get_by_role("button", name="Begin").click()
    expect(page.locator("#text")).to_be_visible()


def prompt_of(page: Page) -> str:
    return page.locator("#prompt").inner_text()


def answer(page: Page, text: str, number: int) -> None:
    """Write at place ``number`` and go on."""
    expect(page.locator(".campaign-bar span")).to_have_text(re.compile(f"^{number} of"))
    page.locator("#text").fill(text)
    page.locator("#text").press("Enter")


def test_from_the_link_to_the_code_on_a_phone(link, logged_in):
    context = logged_in(None, variant=NARROW_LIGHT)
    page, complaints = context.new_page(), []
    listen(page, complaints)
    page.goto(link)
    page.get_by_role("button", name="Begin").click()
    expect(page.get_by_role("alert")).to_contain_text("Tick the box")
    agree(page, link)
    advice = page.locator("#advice")

    # Each piece of advice comes while one types, at its moment.
    prompt = prompt_of(page)
    said, entity = SAID[prompt], {"b": "apple", "t": "living room"}[prompt[0]]
    page.locator("#text").press_sequentially(prompt)
    expect(advice).to_have_text(CLOSE)
    page.locator("#text").fill("")
    page.locator("#text").press_sequentially(said[:8])  # begun: nothing can be missing yet
    expect(advice).to_be_empty()
    page.locator("#text").fill(said.replace(entity, "one"))
    expect(advice).to_have_text(f"“{entity}” is missing.")
    page.locator("#text").fill("x " * 60)
    expect(advice).to_contain_text(FAR)
    page.locator("#text").fill(said)
    expect(advice).to_be_empty()

    # A reload keeps what was typed, and so does another day.
    page.reload()
    expect(page.locator("#text")).to_have_value(said)
    page.locator("#text").press("Enter")
    expect(page.locator(".campaign-bar span")).to_have_text("2 of 3")
    page.goto(link)
    expect(page.locator("main")).to_contain_text("Welcome back")
    page.get_by_role("button", name="Go on").click()

    # Who sends at once what has something missing is told once, and may keep it.
    answer(page, "do something else entirely now", 2)
    expect(page.get_by_role("button", name="Keep it, go on")).to_be_visible()
    expect(advice).to_contain_text("is missing")
    page.locator(".campaign-steps a").click()
    expect(page.locator("#text")).to_have_value(said)
    page.get_by_role("button", name="Save and go on").click()
    answer(page, SAID[prompt_of(page)], 2)
    answer(page, "water the plants on the balcony", 3)

    page.get_by_role("button", name="Finish").click()
    expect(page.get_by_role("alert")).to_contain_text("Choose one")
    page.get_by_label("No, I wrote all of it myself").check()
    page.get_by_role("button", name="Finish").click()
    expect(page.get_by_label("Your completion code")).to_have_value("C0FFEE")
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_role("button", name="Copy the code").click()
    expect(page.get_by_text("Copied", exact=True)).to_be_visible()
    page.get_by_role("link", name="Back to where you came from").click()
    expect(page).to_have_url(re.compile("healthz"))
    assert Contributor.objects.get().is_finished
    assert sorted(Submission.objects.values_list("text", flat=True)) == sorted(
        [*SAID.values(), "water the plants on the balcony"]
    )
    assert not [each for each in complaints if "422" not in each]


def test_by_keyboard_alone(link, page_without_login):
    page = page_without_login
    page.goto(link)
    tab_to(page, page.get_by_label("I agree"))
    page.keyboard.press("Space")
    page.keyboard.press("Enter")
    for number in (1, 2):
        expect(page.locator(".campaign-bar span")).to_have_text(f"{number} of 3")
        expect(page.locator("#text")).to_be_focused()
        page.keyboard.type(SAID[prompt_of(page)])
        page.keyboard.press("Enter")
    expect(page.locator(".campaign-bar span")).to_have_text("3 of 3")
    expect(page.locator("#text")).to_be_focused()
    page.keyboard.type("water the plants")
    tab_to(page, page.get_by_role("button", name="Save and go on"))
    page.keyboard.press("Enter")
    expect(page.locator("h1")).to_have_text("One last question")
    tab_to(page, page.get_by_label("No, I wrote"))
    page.keyboard.press("Space")
    tab_to(page, page.get_by_role("button", name="Finish"))
    page.keyboard.press("Enter")
    expect(page.get_by_label("Your completion code")).to_have_value("C0FFEE")


def test_without_scripts(link, logged_in):
    page = logged_in(None, variant=NARROW_DARK, java_script_enabled=False).new_page()
    agree(page, link)
    prompt = prompt_of(page)
    page.locator("#text").fill(prompt)
    page.get_by_role("button", name="Save and go on").click()
    expect(page.locator("#advice")).to_have_text(CLOSE)
    page.locator("#text").fill(SAID[prompt])
    page.get_by_role("button", name="Keep it, go on").click()
    expect(page.locator(".campaign-bar span")).to_have_text("2 of 3")
    page.reload()
    for text in (SAID[prompt_of(page)], "water the plants"):
        page.locator("#text").fill(text)
        page.get_by_role("button", name="Save and go on").click()
    page.get_by_label("No, I wrote").check()
    page.get_by_role("button", name="Finish").click()
    expect(page.get_by_label("Your completion code")).to_have_value("C0FFEE")


def test_with_the_address_of_a_crowd_market(link, logged_in):
    pid = "5f3e2d1c0b9a877766554433"
    page = logged_in(None, variant=NARROW_LIGHT).new_page()
    agree(page, f"{link}?PROLIFIC_PID={pid}&STUDY_ID=1&SESSION_ID=2")
    assert "PROLIFIC" not in page.url
    answer(page, SAID[prompt_of(page)], 1)
    expect(page.locator(".campaign-bar span")).to_have_text("2 of 3")
    page.goto(f"{link}?PROLIFIC_PID={pid}")
    expect(page.locator("main")).to_contain_text("Welcome back")
    other = logged_in(None, variant=NARROW_LIGHT).new_page()
    other.goto(f"{link}?PROLIFIC_PID={pid}")
    other.get_by_role("button", name="Go on").click()
    expect(other.locator(".campaign-bar span")).to_have_text("2 of 3")
    assert other.locator("#text").input_value() == ""
    assert Contributor.objects.count() == 1


def test_what_is_typed_stays_while_the_server_is_away(link, page_without_login):
    page = page_without_login
    agree(page, link)
    text = SAID[prompt_of(page)]
    page.locator("#text").fill(text)
    page.context.set_offline(True)
    with page.expect_event("requestfailed"):
        page.locator("#text").press("Enter")
    page.context.set_offline(False)
    page.goto(f"{link}1/")
    expect(page.locator("#text")).to_have_value(text)
    page.locator("#text").press("Enter")
    expect(page.locator(".campaign-bar span")).to_have_text("2 of 3")


def test_its_pages_can_be_used_by_everybody(link, logged_in, axe):
    page, reports = logged_in(None, variant=NARROW_DARK).new_page(), {}
    page.add_init_script(axe)

    def look(name: str) -> None:
        address = page.url
        reports[name] = narrow_and_dark(page)
        page.set_viewport_size(WIDE_LIGHT.size)
        page.emulate_media(color_scheme="light")
        reports[f"{name}, wide"] = wide_and_light(page)
        page.set_viewport_size(NARROW_DARK.size)
        page.emulate_media(color_scheme="dark")
        page.goto(address)

    page.goto(link)
    look("begin")
    agree(page, link)
    look("place")
    page.locator("#text").fill("something else")
    page.locator("#text").press("Enter")
    expect(page.get_by_role("button", name="Keep it, go on")).to_be_visible()
    look("advice")
    Submission.objects.update(text="done")
    page.goto(f"{link}done/")
    look("question")
    page.get_by_label("No, I wrote").check()
    page.get_by_role("button", name="Finish").click()
    expect(page.locator("h1")).to_have_text("Thank you")
    look("thanks")
    page.goto(link.replace("/p/", "/p/no"))
    look("refusal")
    assert only_faults(reports) == {}
