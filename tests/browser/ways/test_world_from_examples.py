"""A world from nothing by keys alone: lines with marks, classes named, two verbs joined, and an unseen sentence."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from annotations.models import World
from tests.browser.arriving import arrive, wait_for_swap
from tests.browser.walking import enter, tab_to
from tests.parser_service.live_server import parse_server  # noqa: F401

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

LINES = [
    "water the [tomatoes] in [bed two]",
    "water the [roses] in [bed three]",
    "irrigate the [basil] in [bed two]",
    "irrigate the [roses] in [bed three]",
    "go to the [shed]",
    "go to the [gate]",
    "drive to the [gate] = go",
    "check the [roses]",
    "check the [tomatoes] in [bed two]",
    "take the [tomatoes] to the [shed]",
    "take the [basil] to the [gate]",
    "check the [basil] and go to the [shed]",
]
UNSEEN = "irrigate the tomatoes in bed three"


def settle(page: Page) -> None:
    """Wait until the proposal is that of the lines."""
    page.wait_for_timeout(700)  # as long as the page waits for the next key
    wait_for_swap(page)


def name_class(page: Page, member: str, name: str) -> None:
    field = page.get_by_role("textbox", name=f"The kind of {member}", exact=True)
    tab_to(page, field)
    page.keyboard.type(name)
    page.keyboard.press("Enter")
    expect(page.get_by_label("What people say")).to_have_value(
        re.compile(rf"\[{member}\]\({name}\)")
    )
    settle(page)


def test_a_greenhouse_is_made_by_keys(superuser, logged_in, live_server, parse_server):  # noqa: F811
    page = logged_in(superuser).new_page()
    page.goto(f"{live_server.url}/worlds/new/")
    arrive(page, "New world")
    page.get_by_label("Name").focus()
    page.keyboard.type("greenhouse")
    tab_to(page, page.locator("input[name=starts_with]:checked"))
    page.keyboard.press("ArrowDown")
    expect(page.locator("input[name=starts_with][value='what people say']")).to_be_checked()
    page.keyboard.press("Tab")
    enter(page, "By example")

    lines = page.get_by_label("What people say")
    lines.focus()
    page.keyboard.type("water the tomatoes")
    for _ in "tomatoes":
        page.keyboard.press("Shift+ArrowLeft")
    page.keyboard.press("[")
    expect(lines).to_have_value("water the [tomatoes]")
    page.keyboard.press("End")
    page.keyboard.type(" in [bed two]\n" + "\n".join(LINES[1:]))
    settle(page)
    name_class(page, "tomatoes", "plant")
    name_class(page, "shed", "place")
    expect(page.locator(".example-thing--open")).to_have_count(0)

    doubt = page.locator(".example-doubt", has_text=re.compile("water.*irrigate"))
    tab_to(page, doubt.get_by_role("button", name="Yes"), "Shift+Tab")
    page.keyboard.press("Enter")
    expect(lines).to_have_value(
        re.compile(r"irrigate the \[roses\]\(plant\) in \[bed three\] = water")
    )
    settle(page)
    expect(doubt).to_have_count(0)
    lines.focus()
    page.keyboard.press("Control+z")  # the answer is a change like any other
    expect(lines).not_to_have_value(re.compile("= water"))
    page.keyboard.press("Control+Shift+z")
    expect(lines).to_have_value(re.compile("= water"))

    tab_to(page, page.get_by_role("textbox", name="Try it"))
    page.keyboard.type(UNSEEN)
    page.keyboard.press("Enter")
    expect(page.locator("#tried figure")).to_contain_text("bed three")
    page.keyboard.type("check the gate")
    page.keyboard.press("Control+Enter")
    expect(lines).to_have_value(re.compile(r"\ncheck the \[gate\]\(place\)$"))
    settle(page)

    lines.focus()
    page.keyboard.press("Control+Enter")
    expect(page.locator(".message")).to_contain_text("Added")
    world = World.objects.get(name="greenhouse")
    assert set(world.entity_classes.values_list("token", flat=True)) == {"plant", "bed", "place"}
    assert set(world.predicates.values_list("name", flat=True)) == {"water", "go", "check", "take"}
    assert lines.input_value() == ""

    parse_server.update()
    page.get_by_role("link", name="Try it").focus()
    enter(page, "Parse")
    page.locator("#playground-form [name=text]").focus()
    page.keyboard.type(UNSEEN)
    page.keyboard.press("Control+Enter")
    answer = page.locator("#playground-answer")
    expect(answer.locator("[data-form]").first).to_contain_text("water")
    expect(answer.locator("[data-form]").first).to_contain_text("bed three")
