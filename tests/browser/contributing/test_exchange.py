"""Results of a crowd market in a browser: sent, checked, confirmed, moderated. Pictures go to SCREENSHOTS, if set."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.models import Job, Submission
from tests.browser.faults import listen, narrow_and_dark, only_faults, wide_and_light
from tests.browser.variants import NARROW_DARK, VARIANTS, WIDE_LIGHT
from tests.crowd_tables import results
from tests.launched_campaigns import small_campaign

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

ROWS = [
    {"1": "head into the study", "2": "look for an apple", "free": "water the plants please"},
    {"worker": "W2", "1": "go to the study", "2": "asdf qwer", "Answer.comment": "nice"},
    {"worker": "W3", "1": "spam", "AssignmentStatus": "Rejected"},
]


@pytest.fixture(autouse=True)
def own_folder(settings, tmp_path):
    settings.VAR_DIR = tmp_path


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "results.csv"
    path.write_bytes(results(ROWS))
    return path


def work() -> None:
    carry_out(background.claim("a worker", "quick", Job))


def picture(page: Page, name: str) -> None:
    if folder := os.environ.get("SCREENSHOTS"):
        width = page.viewport_size["width"]
        page.screenshot(path=Path(folder) / f"{name}-{width}.png", full_page=True)


@pytest.mark.parametrize("variant", VARIANTS[::2], ids=["wide", "narrow"])
def test_results_go_from_the_file_to_moderation(
    transactional_db, world, admin, live_server, logged_in, file, variant
):
    campaign = small_campaign(world)
    page, complaints = logged_in(admin, variant=variant).new_page(), []
    listen(page, complaints)
    page.goto(f"{live_server.url}/w/home/campaigns/")
    page.get_by_role("button", name="Import results").click()
    page.get_by_label("File").set_input_files(file)
    page.get_by_label("Name of the new campaign").fill("market")
    picture(page, "form")
    page.get_by_role("button", name="Check the file").click()
    page.wait_for_url("**/jobs/*/")
    work()
    confirm = page.get_by_role("button", name="Import", exact=True)
    expect(confirm).to_be_visible()
    expect(page.get_by_role("cell", name="head into the study")).to_be_visible()
    picture(page, "question")
    assert not Submission.objects.exists()
    confirm.click()
    work()
    link = page.get_by_role("link", name="Moderate them")
    expect(link).to_be_visible()
    picture(page, "done")
    link.click()
    expect(page.get_by_role("link", name="head into the study")).to_be_visible()
    picture(page, "moderation")
    page.goto(f"{live_server.url}/w/home/campaigns/{campaign.pk}/")
    with page.expect_download() as downloaded:
        page.get_by_role("button", name="Download the task file").click()
    assert downloaded.value.path().read_text().startswith("command1,parse1,parse_ground1,")
    picture(page, "campaign")
    assert complaints == []


def test_its_pages_are_usable_by_everybody(
    transactional_db, world, admin, live_server, logged_in, file, axe
):
    campaign = small_campaign(world)
    page = logged_in(admin).new_page()
    page.goto(f"{live_server.url}/w/home/campaigns/results/")
    page.get_by_label("File").set_input_files(file)
    page.get_by_label("Name of the new campaign").fill("market")
    page.get_by_role("button", name="Check the file").click()
    page.wait_for_url("**/jobs/*/")
    job = page.url
    work()
    paths = {
        "form": f"{live_server.url}/w/home/campaigns/results/",
        "question": job,
        "campaign": f"{live_server.url}/w/home/campaigns/{campaign.pk}/",
    }
    reports = {}
    for variant, look in ((WIDE_LIGHT, wide_and_light), (NARROW_DARK, narrow_and_dark)):
        context = logged_in(admin, variant=variant)
        context.add_init_script(axe)
        for name, path in paths.items():
            window = context.new_page()
            window.goto(path)
            reports[f"{name} {look.__name__}"] = look(window)
    assert only_faults(reports) == {}
