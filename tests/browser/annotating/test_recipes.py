"""A recipe is edited with the keyboard, beside an example that follows what is typed."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.browser.arriving import arrive_at

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_the_example_follows_what_is_typed(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    row = sample.world.recipes.get(left="go(destination)")
    page.goto(f"{live_server.url}/w/home/recipes/{row.pk}/")
    text, preview = page.get_by_label("Recipe"), page.locator("#preview")
    expect(preview).to_contain_text("go_to(")
    arrive_at(page, text)
    text.focus()
    page.keyboard.press("ControlOrMeta+End")
    page.keyboard.insert_text(' fly("high")')
    expect(preview).to_contain_text("fly")
    expect(preview.locator(".severity")).to_have_text("error")
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.insert_text('go(destination) -> say("on my way") go_to(destination)')
    expect(preview).to_contain_text('say("on my way")')
    page.keyboard.press("ControlOrMeta+Enter")
    expect(page.locator(".message")).to_contain_text("Saved as version 2")
    row.refresh_from_db()
    assert row.text.startswith('go(destination) -> say("on my way")')


def test_another_book_is_taken_and_undone(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/recipes/")
    page.get_by_role("button", name="Use “").press("Enter")
    expect(page.locator(".message")).to_contain_text("The recipes are now")
    assert not sample.world.recipes.filter(text__contains="go_to(").exists()
    page.get_by_role("button", name="Undo").press("Enter")
    expect(page.locator(".message")).to_contain_text("as they were")
    assert sample.world.recipes.filter(text__contains="go_to(").exists()
