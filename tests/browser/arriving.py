"""Waiting until a page, or a part that came into it, obeys keys and clicks.

Playwright goes on as soon as something is there. Scripts run a moment later, and on a busy machine a key or a
click that comes before them is lost.
"""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Locator, Page, expect

MAIN = Path(__file__).resolve().parents[2] / "static" / "src" / "main.js"
# Selects what a module takes over that is loaded only on the pages that need it.
ENHANCED = ", ".join(re.findall(r'\["(\[data-[a-z-]+\])", "\w+"\]', MAIN.read_text("utf-8")))
assert "[data-editor]" in ENHANCED, f"{MAIN} lists its modules in another way now"


def arrive(page: Page, title: str) -> None:
    """Wait for the page called ``title``, to which a key or a click leads, and for its scripts and modules."""
    expect(page.locator("h1")).to_have_text(title)
    _wait_for_scripts(page)


def arrive_at(page: Page, part: Locator) -> None:
    """Wait as ``arrive`` does for the page that has ``part``, which the page before it has not."""
    expect(part).to_be_visible()
    _wait_for_scripts(page)


def _wait_for_scripts(page: Page) -> None:
    page.wait_for_load_state("domcontentloaded")
    expect(page.locator(f":is({ENHANCED}):not([data-ready])")).to_have_count(0)


def wait_for_swap(page: Page) -> None:
    """Wait until htmx has taken over what it has put into the page."""
    expect(page.locator(".htmx-request, .htmx-added")).to_have_count(0)
