"""The page on which a template is written, for several test files."""

from __future__ import annotations

import re

from playwright.sync_api import Locator, Page, expect


def open_editor(page: Page, url: str, path: str = "new") -> None:
    page.goto(f"{url}/w/home/templates/{path}/")
    expect(page.locator(".cm-editor")).to_have_count(2)  # until then the plain fields are there


def save_button(page: Page) -> Locator:
    """Return the button that saves and stays, not "Save and next"."""
    return page.get_by_role("button", name=re.compile("^Save(?! and)"))


def write(page: Page, pattern: str, form: str) -> None:
    page.get_by_role("textbox", name="Pattern").fill(pattern)
    page.get_by_role("textbox", name="Logical form").fill(form)
