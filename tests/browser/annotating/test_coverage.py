"""From a command without a form to its template, by keyboard."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from annotations.editing.edits import add, delete
from annotations.models import SemanticTemplate

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_a_suggested_form_is_chosen_by_its_digit_and_covers_the_command(
    page_of, live_server, sample, annotator
):
    category = sample.world.grammar.task_categories.get()
    for verb, form in (("seek", "(find (λ$1:e (is_a $1 {kobject})))"), ("fetch", "UNKNOWN")):
        values = {"pattern": f"{verb} the {{kobject}}", "form": form, "status": "ready"}
        add(SemanticTemplate.for_category(category, **values), annotator)
    delete(sample.template, annotator, sample.template.version)
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/coverage/")
    page.keyboard.press("j")
    page.keyboard.press("Enter")
    expect(page.locator(".cm-content").first).to_have_text("$vbfind the {kobject}")
    suggestions = page.get_by_role("group", name="Suggested forms")
    expect(suggestions.get_by_role("radio").first).not_to_be_checked()  # no template says "find"
    expect(page.get_by_text("is asked about")).to_be_visible()  # the answers at once are there
    form = page.locator(".cm-content").nth(1)
    for number in (2, 1):
        page.keyboard.press(str(number))
        chosen = suggestions.get_by_role("radio").nth(number - 1)
        expect(chosen).to_be_checked()
        expect(form).to_have_text(chosen.get_attribute("value"))
    page.get_by_role("textbox", name="Logical form").press("Control+Enter")
    expect(page.locator(".message")).to_contain_text("Saved")
    page.goto(f"{live_server.url}/w/home/coverage/")
    expect(page.get_by_text("Every command looked at has a form.")).to_be_visible()


def test_a_suggestion_is_ready_once_somebody_takes_it(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    delete(sample.template, annotator, sample.template.version)
    category = sample.world.grammar.task_categories.get()
    values = {"pattern": "find me the {kobject}", "status": "ready"}
    form = "(find (λ$1:e (is_a $1 {kobject})))"
    add(SemanticTemplate.for_category(category, form=form, **values), annotator)
    page.goto(f"{live_server.url}/w/home/templates/new/?command=find+the+<object>")
    expect(page.locator(".cm-content").nth(1)).to_have_text(form)
    expect(page.get_by_label("Status")).to_have_value("draft")
    page.locator("h1").click()
    page.keyboard.press("1")
    expect(page.get_by_label("Status")).to_have_value("ready")
