"""The whole workflow in a browser, with a worker that trains."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from tests.browser.arriving import arrive, wait_for_swap
from tests.browser.screenshots import log_in
from tests.parser_service.made_up import TINY
from tests.waiting import PATIENCE_SECONDS

pytestmark = [pytest.mark.browser, pytest.mark.processes, pytest.mark.django_db(transaction=True)]


def start_run(page: Page, url: str) -> None:
    """From the overview to a run of a tiny network."""
    page.goto(f"{url}/w/home/")
    page.click("nav.rail >> text=Runs")
    arrive(page, "Runs")
    page.click("text=Start a run")
    arrive(page, "Start a run")
    page.check("#parser-seq2seq")
    expect(page.locator("#chosen-title")).to_have_text("Sequence to sequence")
    wait_for_swap(page)
    page.select_option("#id_train_sources", "gen")
    page.click("text=Advanced")
    for name, value in {**TINY, "epochs": 12, "patience": 12}.items():
        page.fill(f"#id_config-{name}", str(value))
    page.click("button:has-text('Start the run')")


def test_log_in_start_a_run_watch_it_finish_open_a_prediction(
    page: Page, live_server, sample, admin, worker
):
    page.set_default_timeout(PATIENCE_SECONDS * 1000)
    log_in(page, live_server.url, admin.username, "correct horse")
    start_run(page, live_server.url)
    expect(page.locator("#run-state .status")).to_have_text(re.compile("queued|running|succeeded"))
    expect(page.locator("#run-state .status").first).to_have_text("succeeded")
    expect(page.locator("#run-log .log")).to_contain_text("Finished.")
    expect(page.locator("#loss canvas, #loss svg").first).to_be_visible()
    page.click("#run-state >> text=gen >> nth=0")
    expect(page.locator("h1")).to_contain_text("Predictions")
    page.click("#list a.row-link >> nth=0")
    expect(page.locator("h1")).to_have_text("Review")
    expect(page.locator("[data-answer] code").first).not_to_be_empty()


def test_the_banner_comes_and_goes_with_the_worker(page_of, live_server, annotator, worker):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/")
    expect(page.locator("#worker-state")).to_contain_text("idle")
    expect(page.locator("#banner")).to_be_empty()
    worker.kill_parent()
    expect(page.locator("#banner")).to_contain_text("No worker")
