"""The world is edited with the keyboard alone."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from annotations.models import Entity, Predicate, Production, SemanticTemplate
from tests.browser.arriving import arrive_at

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_a_predicate_is_renamed_after_a_look_at_what_changes(
    page_of, live_server, sample, annotator
):
    page = page_of(annotator)
    row = Predicate.objects.get(name="find")
    page.goto(f"{live_server.url}/w/home/predicates/{row.pk}/")
    page.get_by_role("button", name="Rename").press("Enter")
    arrive_at(page, page.get_by_label("New name"))
    page.get_by_label("New name").focus()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("go")
    expect(page.locator("#touched")).to_contain_text("There is a predicate go already.")
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("locate")
    expect(page.locator("#touched")).to_contain_text("1 template")
    expect(page.locator("#touched ins").first).to_contain_text("locate")
    page.keyboard.press("Enter")
    expect(page.locator(".message")).to_contain_text("Renamed in 1 predicate, 1 template")
    assert SemanticTemplate.objects.filter(form__startswith="(locate").exists()


def test_entities_are_pasted_and_a_production_says_what_saving_does(
    page_of, live_server, sample, annotator
):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/ontology/")
    page.get_by_role("button", name="Paste many").press("Enter")
    arrive_at(page, page.get_by_label("Entities"))
    page.get_by_label("Entities").focus()
    page.keyboard.insert_text("red mug | mug, cup\ntea\nlamp")
    page.get_by_role("button", name="Preview").press("Enter")
    expect(page.get_by_role("heading", name="2 new, 1 there already")).to_be_visible()
    page.get_by_role("button", name="Add 2").press("Enter")
    expect(page.locator(".message")).to_contain_text("Added 2 entities")
    assert Entity.objects.get(text="red mug").aliases == ["mug", "cup"]

    row = Production.objects.get(nonterminal="vbfind")
    page.goto(f"{live_server.url}/w/home/grammar/{row.pk}/")
    expect(page.locator(".cm-editor")).to_have_count(1)  # until then the plain field is there
    expansion = page.get_by_role("textbox", name="Expansion")
    expansion.focus()
    page.keyboard.press("ControlOrMeta+End")
    page.keyboard.type(" | $gone")
    expect(expansion).to_contain_text("$gone")
    expect(page.locator(".editor-report")).to_contain_text("nothing defines $gone")
    for _ in range(5):
        page.keyboard.press("Backspace")
    page.keyboard.type("seek")
    expect(page.locator("#preview")).to_contain_text("1 command newly covered")
    page.keyboard.press("ControlOrMeta+Enter")
    expect(page.locator(".message")).to_contain_text("Saved as version 2")
    assert sample.world.commands.filter(anonymized_text="seek the <object>").exists()
