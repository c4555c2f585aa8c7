"""From the log-in to what matters, and the form that starts a run, in a browser."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from annotations.models import TaskCategory
from parser_service.models import Evaluation, TrainingRun
from tests.browser.arriving import wait_for_swap
from tests.browser.faults import SETTLED
from tests.browser.screenshots import log_in
from tests.browser.variants import NARROW_DARK
from tests.parser_service.made_up import make_split

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_wrong_answers_are_one_click_from_the_log_in(page: Page, live_server, sample, reviewer):
    Evaluation.objects.update(test_source="mixed")
    log_in(page, live_server.url, reviewer.username, "correct horse")
    expect(page.locator("h1")).to_have_text("Overview")
    page.click("text=its 9 wrong answers")
    expect(page.locator("h1")).to_have_text("Review")
    expect(page.locator("[data-review-place]")).to_have_text("No. 1 of 9")


def test_choices_survive_a_change_of_parser(page_of, live_server, sample, admin):
    second = make_split(sample.world, "second")
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/runs/new/?parser=seq2seq")
    page.select_option("#id_split", str(second.pk))
    page.select_option("#id_train_sources", "gen+para")
    page.fill("#id_seed", "42")
    page.fill("#id_seeds", "2")
    page.check("#parser-knn")
    expect(page.locator("#chosen-title")).to_have_text("Nearest neighbour")
    expect(page.locator("#id_split")).to_have_value(str(second.pk))
    expect(page.locator("#id_train_sources")).to_have_value("gen+para")
    expect(page.locator("#id_seed")).to_have_value("42")
    expect(page.locator("#id_seeds")).to_have_value("2")
    expect(page).to_have_url(re.compile("parser=knn"))
    assert "csrf" not in page.url
    wait_for_swap(page)
    page.click("button:has-text('Start the run')")
    expect(page.locator("h1")).to_have_text("Runs")
    asked = TrainingRun.objects.filter(split=second).values_list("parser", "train_sources", "seed")
    assert sorted(asked) == [("knn", "gen+para", 42), ("knn", "gen+para", 43)]


def test_parsers_are_chosen_by_keyboard(page_of, live_server, sample, admin):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/runs/new/?parser=grammar-oracle")
    page.locator("#parser-grammar-oracle").focus()
    page.keyboard.press("ArrowDown")
    expect(page.locator("#chosen-title")).to_have_text("Nearest neighbour")
    expect(page.locator("#parser-knn")).to_be_focused()
    wait_for_swap(page)
    page.keyboard.press("ArrowDown")
    expect(page.locator("#chosen-title")).to_have_text("Linear classifier")


def test_without_scripts_a_parser_is_chosen_by_button(browser, live_server, sample, admin):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    log_in(page, live_server.url, admin.username, "correct horse")
    page.goto(f"{live_server.url}/w/home/runs/new/?parser=knn")
    page.fill("#id_seed", "42")
    page.check("#parser-ranker")
    page.click("button:has-text('Show the settings')")
    expect(page.locator("#chosen-title")).to_have_text("Form ranker")
    expect(page.locator("#id_seed")).to_have_value("42")
    context.close()


def test_bars_of_coverage_have_one_length(page_of, live_server, sample, annotator):
    second, third = (
        TaskCategory(grammar=sample.world.grammar, name=name, position=position)
        for position, name in enumerate(("second", "a category with a long name"), start=5)
    )
    second.commands_in_grammar, second.commands_with_form = 12_000, 40
    third.commands_in_grammar, third.commands_with_form = 7, 7
    TaskCategory.objects.bulk_create([second, third])
    page = page_of(annotator)
    for width in (1280, 1000, 390):
        page.set_viewport_size({"width": width, "height": 800})
        page.goto(f"{live_server.url}/w/home/")
        widths = page.eval_on_selector_all(
            ".coverage-bar", "bars => bars.map((bar) => Math.round(bar.clientWidth))"
        )
        assert len(widths) == 3 and len(set(widths)) == 1, (width, widths)


COVERED = """() => [...document.querySelectorAll("main a, main button, main input, main select")]
  .filter((element) => element.checkVisibility() && element.type !== "hidden")
  .filter((element) => {
    element.focus();
    const {left, top, width, height} = element.getClientRects()[0];
    const seen = document.elementFromPoint(left + width / 2, top + height / 2);
    return !element.contains(seen);
  })
  .map((element) => element.outerHTML.slice(0, 80))"""


def test_the_banner_covers_nothing_that_has_the_focus(page_of, live_server, sample, admin):
    page = page_of(admin, variant=NARROW_DARK)
    for path in ("templates/new/", "queue/settings/"):
        page.goto(f"{live_server.url}/w/home/{path}")
        expect(page.locator("#banner")).to_contain_text("No worker is running.")
        page.evaluate(SETTLED)
        assert page.evaluate(COVERED) == [], path


def test_the_first_tab_leads_past_the_rail(page_of, live_server, sample, admin):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/")
    page.keyboard.press("Tab")
    expect(page.locator(".skip")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.locator("#main")).to_be_focused()
