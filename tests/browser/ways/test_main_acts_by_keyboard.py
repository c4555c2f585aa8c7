"""What one comes to Start a run, Settings, Import and Parse for, by keyboard alone, each from Overview.

Review, Results and the template editor: ways/test_keyboard_walk.py and reviewing/test_review_walk.py.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from annotations.models import Invitation
from parser_service.models import TrainingRun
from parser_service.runs.promoting import promote
from tests.browser.arriving import arrive, arrive_at, wait_for_swap
from tests.browser.walking import follow, place, skip_to_content, tab_to
from tests.filled_world import save_parser
from tests.parser_service.live_server import parse_server  # noqa: F401

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.fixture
def page(page_of, live_server, sample, admin) -> Page:
    """Overview, with nothing clicked."""
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/")
    arrive(page, "Overview")
    return page


def test_a_run_is_started(page, sample):
    follow(page, place(page, "Runs"), "Runs")
    skip_to_content(page)
    follow(page, page.get_by_role("button", name="Start a run"), "Start a run")
    skip_to_content(page)
    tab_to(page, page.locator("[name=parser]:checked"))
    page.keyboard.press("ArrowDown")
    expect(page.locator("[name=parser]:focus")).to_be_checked()
    chosen = page.locator("[name=parser]:checked").get_attribute("value")
    wait_for_swap(page)
    tab_to(page, page.get_by_role("button", name="Start the run"))
    page.keyboard.press("Enter")
    arrive_at(page, page.locator("#run-state"))
    assert TrainingRun.objects.latest("pk").parser == chosen


def test_somebody_is_invited(page):
    follow(page, place(page, "Settings"), "People")
    skip_to_content(page)
    invitation = page.locator("form", has=page.get_by_role("button", name="Make a link"))
    tab_to(page, invitation.get_by_label("Annotator"))
    page.keyboard.press("Space")
    page.keyboard.press("Enter")
    expect(page.get_by_role("textbox", name="Link of the invitation")).to_be_focused()
    assert Invitation.objects.get().roles == ["annotator"]


def test_files_are_imported_and_their_commands_generated(
    logged_in, live_server, world, admin, shared_data, settings, tmp_path
):
    settings.VAR_DIR = tmp_path
    files = [each for each in (shared_data / "generator-2018").glob("*") if each.is_file()]
    if not files:
        pytest.skip("needs generator-2018 in GPSR_SHARED_DATA")
    page = logged_in(admin).new_page()
    page.goto(f"{live_server.url}/w/home/")
    arrive(page, "Overview")
    follow(page, place(page, "Settings"), "People")
    skip_to_content(page)
    follow(page, page.locator("main").get_by_role("link", name="Import"), "Import and export")
    skip_to_content(page)
    choose(page, files)
    tab_to(page, page.get_by_role("button", name="Import", exact=True))
    page.keyboard.press("Enter")
    arrive_at(page, page.locator("#job-state"))
    generate = page.get_by_role("button", name="Generate commands")
    expect(generate).to_be_visible()
    follow(page, generate, "Commands")
    assert world.commands.count() > 1000


def choose(page: Page, files: list[Path]) -> None:
    """Go to the field of files and fill it; the dialog that a key opens there is not the page's."""
    field = page.locator("main [name=files]")
    tab_to(page, field)
    field.set_input_files(files)


def test_a_text_is_parsed_and_its_plan_read(page, sample, parse_server):  # noqa: F811
    save_parser(sample.run)
    promote(sample.run, None)
    parse_server.update()
    follow(page, place(page, "Parse"), "Parse")
    expect(page.get_by_role("textbox", name="Utterance")).to_be_focused()
    page.keyboard.type("locate the tea")
    expect(page.locator("#playground-answer")).to_contain_text("Plan")
    expect(page.locator("#playground-answer")).to_contain_text("tea")
