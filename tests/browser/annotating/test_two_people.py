"""Two browsers on one row: the second to save gets the merge, and nothing that either typed is lost."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from annotations.models import SemanticTemplate
from annotations.rows.row_kinds import KINDS, as_text
from tests.browser.arriving import arrive
from tests.browser.writing import save_button

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_two_browsers_on_one_template(logged_in, sample, live_server, annotator, admin):
    annas, adams = logged_in(annotator).new_page(), logged_in(admin).new_page()
    for page in (annas, adams):
        page.goto(f"{live_server.url}/w/home/templates/{sample.template.pk}/")
        expect(page.locator(".cm-editor")).to_have_count(2)
        expect(page.get_by_label("Status")).to_have_value("ready")
    adams.get_by_role("textbox", name="Pattern").fill("$vbfind a $object")
    save_button(adams).click()
    expect(adams.locator(".message")).to_contain_text("Saved as version 2")

    annas.get_by_role("textbox", name="Pattern").fill("$vbfind my $object")
    annas.get_by_role("combobox", name="Status").select_option("draft")
    save_button(annas).click()
    expect(annas.get_by_role("alert").first).to_contain_text("adam has saved version 2")
    arrive(annas, "Merge two changes")
    pattern = annas.get_by_role("textbox", name="Pattern")
    expect(pattern).to_have_text("$vbfind my $object")
    expect(annas.get_by_role("combobox", name="Status")).to_have_value("draft")
    annas.get_by_role("button", name=re.compile("Pattern, Saved by adam")).click()
    expect(pattern).to_have_text("$vbfind a $object")
    annas.get_by_role("button", name=re.compile("Pattern, Yours")).click()
    expect(pattern).to_have_text("$vbfind my $object")
    annas.get_by_role("button", name="Save the merged template").click()
    expect(annas.locator(".message")).to_contain_text("Saved as version 3")

    row = SemanticTemplate.objects.get(pk=sample.template.pk)
    assert (row.pattern, row.status) == ("$vbfind my $object", "draft")
    said = row.history.order_by("version").values_list("pattern", flat=True)
    assert list(said)[1:] == ["$vbfind a $object", "$vbfind my $object"]


@pytest.mark.parametrize(
    ("kind", "list_page", "field", "editors"),
    [("entity", "ontology", "Aliases", 0), ("production", "grammar", "Expansion", 1)],
)
def test_two_browsers_on_one_row_of_another_kind(
    kind, list_page, field, editors, logged_in, sample, live_server, annotator, admin
):
    row = KINDS[kind].rows_of(sample.world).first()
    annas, adams = logged_in(annotator).new_page(), logged_in(admin).new_page()
    for page in (annas, adams):
        page.goto(f"{live_server.url}/w/home/{list_page}/{row.pk}/")
        expect(page.locator(".cm-editor")).to_have_count(editors)
        page.get_by_role("textbox", name=field).fill("theirs" if page is adams else "mine")
    adams.get_by_role("button", name="Save as version 2").click()
    expect(adams.locator(".message")).to_contain_text("Saved as version 2")
    annas.get_by_role("button", name="Save as version 2").click()
    expect(annas.get_by_role("alert").first).to_contain_text("adam has saved version 2")
    expect(annas.get_by_role("region", name=field)).to_contain_text("theirs")
    expect(annas.get_by_role("region", name=field)).to_contain_text("mine")
    annas.get_by_role("button", name=f"Save the merged {kind}").click()
    expect(annas.locator(".message")).to_contain_text("Saved as version 3")
    name = {"entity": "aliases", "production": "expansion"}[kind]
    said = [as_text(getattr(entry, name)) for entry in row.history.order_by("version")]
    assert said[1:] == ["theirs", "mine"]
