"""Using the pages: keys, filters while typing, search, light and dark, pages without scripts."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from tests.annotations.showing.test_list_pages import many_commands
from tests.browser.arriving import wait_for_swap

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_rows_are_walked_and_opened_by_keys(page_of, live_server, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/commands/")
    page.keyboard.press("j")
    page.keyboard.press("j")
    page.keyboard.press("k")
    page.keyboard.press("j")
    expect(page.locator("tbody tr").nth(1)).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.locator("h1")).to_have_text("locate the object")
    expect(page.locator("h2").first).to_have_text("Logical form")


def test_a_slash_leads_to_the_search_of_every_page(page_of, live_server, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/results/")
    page.keyboard.press("/")
    page.keyboard.type("locate")
    page.keyboard.press("Enter")
    expect(page).to_have_url(re.compile("/search/.q=locate"))
    commands = page.get_by_role("region", name="Commands")
    expect(commands.locator("tbody tr")).to_have_count(1)
    commands.get_by_role("link", name="all 1").click()
    expect(page).to_have_url(re.compile("/commands/.q=locate"))
    expect(page.locator("#list tbody tr")).to_have_count(1)


def test_the_search_answers_while_one_types_and_acts_by_keys(page_of, live_server, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/results/")
    field, found = page.get_by_role("combobox", name="Search home"), page.locator("#search-found")
    page.keyboard.press("/")
    page.keyboard.type("locate")
    option = found.get_by_role("option", name="locate the")
    expect(option.first).to_be_visible()
    expect(field).to_have_attribute("aria-expanded", "true")
    page.keyboard.press("Escape")
    expect(found).to_be_hidden()
    expect(field).to_be_focused()
    expect(field).to_have_value("locate")
    page.keyboard.press("ArrowDown")
    expect(field).to_have_attribute("aria-activedescendant", "found-1-1")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowUp")
    expect(field).to_have_attribute("aria-activedescendant", "found-all")
    field.fill("guideli")
    expect(found.get_by_role("option", name="Guidelines").first).to_be_visible()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    expect(page).to_have_url(re.compile("/guidelines/$"))


def test_lists_are_turned_by_keys(page_of, live_server, annotator, sample):
    many_commands(sample.world, 70)
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/commands/")
    first = page.locator("#list tbody tr td").first
    expect(first).to_have_text("1")
    page.keyboard.press("n")
    expect(first).to_have_text("51")
    wait_for_swap(page)
    page.keyboard.press("p")
    expect(first).to_have_text("1")


def test_the_keys_dialog_promises_what_works(page_of, live_server, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/commands/")
    page.keyboard.press("?")
    expect(page.locator("#keys")).to_be_visible()
    keys = set(page.locator("#keys kbd").all_inner_texts())
    of_lists, of_editors = (
        {"/", "j", "k", "n", "p", "c", "x", "z", "Enter", "?"},
        {"Ctrl", ".", "F8", "Alt", "↑", "↓", "Shift", "F", "\\"},
    )
    assert keys == of_lists | of_editors
    over = "terms => terms.filter(each => each.scrollWidth > each.clientWidth).map(each => each.innerText)"
    assert page.locator("#keys dt").evaluate_all(over) == []


def test_the_search_stays_where_it_is(page_of, live_server, annotator, sample):
    page, seen = page_of(annotator), set()
    for path in ("", "commands/", "coverage/conflicts/", f"runs/{sample.run.pk}/predictions/"):
        page.goto(f"{live_server.url}/w/home/{path}")
        for state in ("Worker idle", "No training worker, 12 waiting"):
            page.evaluate(
                "said => (document.querySelector('.worker span:last-child').textContent = said)",
                state,
            )
            box = page.locator(".topbar .search").bounding_box() or {}
            seen.add((box["x"], box["width"]))
    assert len(seen) == 1


def test_enter_in_a_field_of_a_new_split_stores_nothing(page_of, live_server, annotator, sample):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/splits/new/")
    page.get_by_label("Name").press("Enter")
    expect(page.get_by_role("heading", name="Preview")).to_be_visible()
    assert sample.world.splits.count() == 1


def test_a_list_follows_what_one_types_and_so_does_the_address(page_of, live_server, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/commands/")
    page.fill("main input[type=search]", "locate")
    expect(page.locator("#list tbody tr")).to_have_count(1)
    expect(page).to_have_url(re.compile("q=locate"))
    wait_for_swap(page)
    page.locator(".filter-chip").click()
    expect(page.locator("#list tbody tr")).to_have_count(3)


def test_near_duplicates_are_compared_when_they_are_asked_for(
    page_of, live_server, annotator, sample
):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/splits/{sample.split.pk}/")
    near = page.get_by_label("Near duplicates")
    expect(near).to_have_attribute("aria-busy", "true")
    page.locator("summary", has_text="Near duplicates").click()
    expect(near).to_contain_text("of 12 pairs of validation")


def test_light_and_dark_are_a_choice_that_stays(page_of, live_server, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/")
    page.click("[data-theme-toggle]")
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")


def test_the_first_field_of_a_form_with_an_error_has_the_focus(page_of, live_server, admin):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/people/")
    page.get_by_role("button", name="Make a link").click()
    roles = page.locator(".field", has_text="Choose at least one role.")
    expect(roles.get_by_label("Annotator")).to_be_focused()


def test_without_scripts_one_logs_in_and_filters(browser, live_server, sample, annotator):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(f"{live_server.url}/w/home/commands/")
    page.fill("#id_username", annotator.username)
    page.fill("#id_password", "correct horse")
    page.click("button[type=submit]")
    page.fill("main input[type=search]", "locate")
    page.click("main button:has-text('Filter')")
    expect(page.locator("#list tbody tr")).to_have_count(1)
    context.close()


def test_one_reads_prediction_after_prediction_by_key(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/runs/{sample.run.pk}/predictions/?outcome=wrong")
    page.keyboard.press("j")
    page.keyboard.press("Enter")
    expect(page.locator("[data-answer]")).to_be_focused()
    first = page.locator("#case h2").inner_text()
    page.keyboard.press("j")
    expect(page.locator("#case h2")).not_to_have_text(first)
    wait_for_swap(page)
    page.keyboard.press("k")
    expect(page.locator("#case h2")).to_have_text(first)
