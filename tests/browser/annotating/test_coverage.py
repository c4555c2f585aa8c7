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


@pytest.fixture
def find_me(sample, annotator) -> str:
    """The form of three templates that say how to find; none covers "find the <object>"."""
    delete(sample.template, annotator, sample.template.version)
    form = "(find (λ$1:e (is_a $1 {kobject})))"
    category = sample.world.grammar.task_categories.get()
    for pattern in ("find me the {kobject}", "locate me the {kobject}", "find a {kobject}"):
        values = {"pattern": pattern, "form": form, "status": "ready"}
        add(SemanticTemplate.for_category(category, **values), annotator)
    return form


def test_a_sure_form_is_filled_in_and_editing_clears_the_choice(
    page_of, live_server, annotator, find_me
):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/templates/new/?command=find+the+<object>")
    form = page.get_by_role("textbox", name="Logical form")
    expect(form).to_have_text(find_me)
    expect(page.get_by_label("Status")).to_have_value("ready")
    first = page.get_by_role("group", name="Suggested forms").get_by_role("radio").first
    expect(first).to_be_checked()
    form.press("End")
    page.keyboard.type("x")
    expect(first).not_to_be_checked()
    page.keyboard.press("Backspace")
    expect(first).to_be_checked()


def test_two_clicks_from_a_command_to_a_filled_editor_and_one_key_to_the_next(
    page_of, live_server, sample, annotator
):
    for row in SemanticTemplate.objects.filter(grammar__world=sample.world):
        delete(row, annotator, row.version)
    category = sample.world.grammar.task_categories.get()
    for pattern in ("seek the {kobject}", "fetch the {kobject}"):
        form = "(find (λ$1:e (is_a $1 {kobject})))"
        made = SemanticTemplate.for_category(category, pattern=pattern, form=form, status="ready")
        add(made, annotator)
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/coverage/?q=locate")
    page.get_by_role("button", name="Write a template for locate the").click()
    expect(page.locator(".cm-editor")).to_have_count(2)
    page.locator(".suggestion").first.click()
    form = page.get_by_role("textbox", name="Logical form")
    expect(form).to_have_text("(find (λ$1:e (is_a $1 {kobject})))")
    expect(page.get_by_role("textbox", name="Pattern")).to_have_text("$vbfind the {kobject}")
    page.keyboard.press("Control+Shift+Enter")
    expect(page.locator(".message")).to_contain_text("Saved")
    expect(page.locator("h1")).to_have_text("New template")
    assert page.url.endswith("?task_category=1&command=go+to+the+%3Croom%3E")
    expect(page.get_by_role("textbox", name="Pattern")).to_have_text("go to the {room}")
    expect(page.locator(".cm-content:focus")).to_have_count(1)
    assert SemanticTemplate.objects.filter(pattern="$vbfind the {kobject}").count() == 1


def test_the_page_after_a_save_is_that_of_the_template(page_of, live_server, annotator, find_me):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/templates/new/?command=find+the+<object>")
    expect(page.locator(".cm-editor")).to_have_count(2)
    count = SemanticTemplate.objects.count()
    page.evaluate(
        "document.body.dispatchEvent(new KeyboardEvent('keydown', "
        "{ key: 'Enter', ctrlKey: true, shiftKey: true, repeat: true, bubbles: true }))"
    )  # the key that saved the page before is still held down
    expect(page.get_by_text("Draft saved")).to_have_count(0)
    assert SemanticTemplate.objects.count() == count
    page.keyboard.press("Control+Enter")  # nobody has clicked into a field
    expect(page.locator(".message")).to_contain_text("Saved")
    made = SemanticTemplate.objects.latest("pk")
    assert page.url == f"{live_server.url}/w/home/templates/{made.pk}/"
