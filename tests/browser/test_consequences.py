"""What saving a template would do, shown while it is written; what it did, and taken back again."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from annotations.models import SemanticTemplate
from tests.browser.writing import open_editor, write

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def forms(world) -> dict[str, str]:
    return dict(world.commands.values_list("anonymized_text", "logical_form__text"))


def test_consequences_before_saving_are_those_of_saving_and_are_taken_back(
    page_of, live_server, annotator, sample
):
    before = forms(sample.world)
    row = SemanticTemplate.objects.get(form="(go {room})")
    page = page_of(annotator)
    open_editor(page, live_server.url, str(row.pk))
    panel = page.locator("#consequences")
    expect(panel).to_contain_text("No command changes")
    write(page, row.pattern, "(find {room})")
    expect(panel).to_contain_text("1 command with another form")
    page.keyboard.press("Control+Enter")
    expect(page.locator(".message")).to_contain_text(
        "Saved as version 2. 1 command with another form"
    )
    assert forms(sample.world) == {**before, "go to the <room>": '( find " <room> " )'}
    open_editor(page, live_server.url, str(row.pk))
    write(page, row.pattern, row.form)
    expect(panel).to_contain_text("1 command with another form")
    page.keyboard.press("Control+Enter")
    expect(page.locator(".message")).to_contain_text("Saved as version 3.")
    assert forms(sample.world) == before
