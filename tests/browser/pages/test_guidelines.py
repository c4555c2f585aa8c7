"""The guidelines beside the item are opened by a key, and stay as they were left."""

from __future__ import annotations

from playwright.sync_api import expect

from annotations.models import Guidelines


def test_the_panel_opens_by_key_and_is_remembered(page_of, live_server, sample, annotator):
    Guidelines.objects.create(world=sample.world, text="# Say *bring*\n\n- one\n- two")
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/label/")
    words = page.get_by_role("heading", name="Say bring")
    expect(words).to_be_hidden()
    page.keyboard.press("g")
    expect(words).to_be_visible()
    page.reload()
    expect(words).to_be_visible()
    page.keyboard.press("g")
    expect(words).to_be_hidden()
