"""Reading documents in the browser: the world of the last page stays beside them, and a search leads to its heading."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser


def test_documents_and_the_account_keep_the_world_that_one_came_from(
    page_of, live_server, annotator
):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/docs/")
    expect(page.locator(".rail a[href='/w/home/commands/']")).to_have_count(0)
    page.goto(f"{live_server.url}/w/home/")
    page.locator(".rail").get_by_role("link", name="Documents").click()
    expect(page.locator("h1")).to_have_text("GPSR Workbench")
    page.goto(f"{live_server.url}/account/")
    page.locator(".rail a[href='/w/home/commands/']").click()
    expect(page.locator("h1")).to_have_text("Commands")


def test_a_search_leads_to_the_heading_of_what_it_found(page_without_login, live_server):
    page = page_without_login
    page.goto(f"{live_server.url}/docs/guides/splits/")
    page.get_by_role("searchbox", name="Search the documents").fill("trees try again")
    page.keyboard.press("Enter")
    page.get_by_role("link", name="For robots · Trees that try again").click()
    expect(page.locator("#doc-trees-that-try-again")).to_be_in_viewport()
