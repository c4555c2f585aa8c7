"""Using pages by keyboard alone: to a link, a field or a button by Tab, and on by Enter."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.arriving import arrive

MOST_TABS = 40


def tab_to(page: Page, target: Locator, key: str = "Tab") -> None:
    """Press ``key`` until ``target`` has the focus."""
    for _ in range(MOST_TABS):
        page.keyboard.press(key)
        if target.evaluate("target => target.contains(document.activeElement)"):
            return
    pytest.fail(f"{MOST_TABS} times {key} do not reach {target}")


def skip_to_content(page: Page) -> None:
    """Go to the beginning of the content by the skip link; after an action the focus is in the content already."""
    if page.locator("#main:focus, #main :focus").count():
        page.locator("#main").focus()
        return
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    expect(page.locator("main")).to_be_focused()


def follow(page: Page, target: Locator, title: str) -> None:
    """Open a link by Tab and Enter; the page that it leads to is called ``title``."""
    tab_to(page, target)
    enter(page, title)


def enter(page: Page, title: str) -> None:
    """Press Enter; the page that it leads to is called ``title``."""
    with page.expect_navigation(wait_until="domcontentloaded"):  # also to a page of the same title
        page.keyboard.press("Enter")
    arrive(page, title)


def place(page: Page, name: str) -> Locator:
    """Return the link of the rail that is called ``name``."""
    return page.locator("#rail a", has_text=name)
