"""An annotator's sitting by keyboard alone: a template is written, mended, saved and taken back; then fifty
utterances are labelled."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import Page, expect

from annotations.editing.edits import delete
from annotations.labelling.collecting import collect
from annotations.models import Entity, Label, SemanticTemplate, Utterance
from annotations.models.worlds import World
from tests.browser.arriving import arrive
from tests.browser.walking import follow, place, skip_to_content, tab_to
from tests.waiting import wait_for

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

# What each of them has in store stands in ``label_fifty``.
SAID = [f"find the tea {said}" for said in ("now", "please", "quickly", "for me", "at once")]
SAID += [f"go to the kitchen {said}" for said in ("now", "please", "again", "for me")]
SAID += ["fetch my cuppa", *(f"go to the bath {time} times" for time in range(2, 42))]


def log_in(page: Page) -> None:
    """Type name and password; the cursor stands in the first field."""
    expect(page.get_by_label("Username")).to_be_focused()
    page.keyboard.type("anna")
    tab_to(page, page.get_by_label("Password"))
    page.keyboard.type("correct horse")
    page.keyboard.press("Enter")
    arrive(page, "Overview")  # of the only world


def expect_counts(page: Page, templates: int, commands: int, covered: str) -> None:
    """The overview and its rail say how much there is, and how much of the grammar has a form."""
    follow(page, place(page, "Overview"), "Overview")
    for name, count in (("Templates", templates), ("Commands", commands)):
        expect(place(page, name).locator(".rail-count")).to_have_text(str(count))
    expect(page.locator(".coverage-bars")).to_contain_text(covered)


def write_template(page: Page) -> None:
    """Type a template with mistakes, and take the repairs that are offered."""
    expect(page.locator(".cm-editor")).to_have_count(2)  # until then the plain fields are there
    pattern, form = (page.get_by_role("textbox", name=name) for name in ("Pattern", "Logical form"))
    reports = page.locator(".editor-report")
    tab_to(page, pattern)
    page.keyboard.type("$vbfind me the {kobject}")
    tab_to(page, form)
    # A backslash is a λ; the closing brackets come by themselves, and one is taken away.
    page.keyboard.type("(fnd (\\$1:e (is_a $1 {kobject}))")
    page.keyboard.press("End")
    page.keyboard.press("Backspace")
    expect(reports.nth(1)).to_contain_text("ends too early")
    page.keyboard.press("Control+.")
    expect(reports.nth(1)).to_contain_text("there is no predicate fnd")
    tab_to(page, page.get_by_role("button", name="Write find for fnd"))
    page.keyboard.press("Enter")
    expect(form).to_have_text("(find (λ$1:e (is_a $1 {kobject})))")
    expect(reports.nth(1)).to_contain_text("find the object")
    expect(reports.first).to_contain_text("matches nothing in the grammar")
    tab_to(page, pattern, "Shift+Tab")
    page.keyboard.press("Home")
    for _ in "$vbfind me":
        page.keyboard.press("ArrowRight")
    for _ in " me":
        page.keyboard.press("Backspace")
    expect(page.locator("#preview")).to_contain_text("2 commands")
    expect(page.locator("#consequences")).to_contain_text("2 commands newly covered")
    page.keyboard.press("Control+Enter")
    expect(page.locator(".message")).to_contain_text("Saved. 2 commands newly covered")


def expect_utterance(page: Page, text: str) -> None:
    """Wait until an utterance is shown and takes keys, which is once somebody can have read it."""
    key = Utterance.objects.get(text=text).pk
    expect(page.locator(f"[data-item='{key}'][data-asks]")).to_have_count(1)


def label_fifty(page: Page) -> None:
    """Use every key of the page, and take the first candidate for most utterances."""
    said = iter(SAID)
    expect(page.locator("[data-label-page][data-ready]")).to_have_count(1)
    press_each(page, said, "11111us")
    dispute_and_take_back(page, next(said), after=SAID[8])
    write_form(page, SAID[7])
    press_each(page, said, "1")
    name_entity(page, next(said))
    press_each(page, said, "1" * 40)
    expect(page.locator("[data-label-done]")).to_be_visible()


def press_each(page: Page, said: Iterator[str], keys: str) -> None:
    """Press one of ``keys`` at each of the next utterances."""
    for key in keys:
        expect_utterance(page, next(said))
        page.keyboard.press(key)


def dispute_and_take_back(page: Page, text: str, after: str) -> None:
    expect_utterance(page, text)
    page.keyboard.press("d")
    expect(page.get_by_label("Why is it disputed?")).to_be_focused()
    page.keyboard.type("again or not")
    page.keyboard.press("Enter")
    expect_utterance(page, after)
    page.keyboard.press("z")  # the dispute is taken back, and its utterance is there again
    expect_utterance(page, text)


def write_form(page: Page, text: str) -> None:
    """Write a form instead of a candidate: one that is refused, and one that is taken."""
    keys = page.keyboard
    expect_utterance(page, text)
    keys.press("e")
    editor = page.get_by_role("textbox", name="Logical form")
    expect(page.locator(".cm-editor")).to_have_count(1)  # until then the plain field is there
    expect(editor).to_be_focused()
    keys.press("ControlOrMeta+a")  # what candidate 1 says
    keys.type("(go")
    keys.press("Delete")  # the closing bracket, which came by itself
    keys.press("Control+Enter")  # refused, and what was written stays
    expect(page.get_by_role("alert")).to_contain_text("ends too early")
    expect(editor).to_contain_text("(go")
    keys.press("ControlOrMeta+a")
    keys.type('(go "<room>")')
    keys.press("Control+Enter")


def name_entity(page: Page, text: str) -> None:
    """Say which words name an entity, then take the first candidate."""
    expect_utterance(page, text)
    page.keyboard.press("m")
    expect(page.get_by_label("The words")).to_be_focused()
    page.keyboard.type("cuppa")
    page.keyboard.press("Tab")
    page.keyboard.type("tea (object)")
    page.keyboard.press("Enter")
    expect(page.locator(".label-text .chip")).to_contain_text("cuppa")
    page.keyboard.press("1")


def forms(world: World) -> dict[str, str]:
    return dict(world.commands.values_list("anonymized_text", "logical_form__text"))


def test_an_annotators_sitting_without_a_mouse(page_of, live_server, sample, annotator):
    world = sample.world
    delete(sample.template, annotator, sample.template.version)
    collect(world, SAID, by=annotator)
    before = forms(world)
    page = page_of(None)
    page.goto(f"{live_server.url}/")
    log_in(page)
    expect_counts(page, 1, 1, "33.3 %")

    add_template(page)
    assert forms(world).keys() - before == {"find the <object>", "locate the <object>"}
    expect_counts(page, 2, 3, "100.0 %")

    delete_template(page)
    assert forms(world) == before
    expect_counts(page, 1, 1, "33.3 %")

    follow(page, place(page, "Label"), "Label")
    label_fifty(page)
    expect_fifty_labels()
    assert SemanticTemplate.objects.count() == 1


def add_template(page: Page) -> None:
    follow(page, place(page, "Templates"), "Templates")
    skip_to_content(page)
    follow(page, page.get_by_role("button", name="New template"), "New template")
    skip_to_content(page)
    write_template(page)


def delete_template(page: Page) -> None:
    """Delete the second template of the list, whose page says what it takes with it."""
    follow(page, place(page, "Templates"), "Templates")
    page.keyboard.press("j")
    page.keyboard.press("j")
    page.keyboard.press("Enter")
    arrive(page, "Template")
    skip_to_content(page)
    follow(page, page.get_by_role("button", name="Delete"), "Delete template")
    expect(page.locator("main")).to_contain_text("2 commands")
    skip_to_content(page)
    tab_to(page, page.get_by_role("button", name="Delete"))
    page.keyboard.press("Enter")
    expect(page.locator(".message")).to_contain_text("Deleted")


def expect_fifty_labels() -> None:
    assert len(SAID) == 50  # the page goes on while the last answer is on its way
    wait_for(lambda: Label.objects.valid().count() == len(SAID), "every answer is stored")
    assert Label.objects.exclude(seconds=None).count() == 51
    assert Utterance.objects.get(text=SAID[7]).logical_form == '( go " <room> " )'
    assert Entity.objects.get(text="tea").aliases == ["cuppa"]
