"""From a figure of the results table to a corrected label, a new split and a retrained run, by keyboard alone.

``TEST_WALK=full`` walks on the whole of walker2019 with parsers as they are trained by default.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import Locator, Page, expect

from annotations.models import Example, Paraphrase
from parser_service.models import Review, TrainingRun
from tests.browser.arriving import arrive, arrive_at
from tests.browser.reviewing.trained_world import IS_FULL, doubtful, train_three
from tests.browser.walking import enter, follow, place, skip_to_content, tab_to
from tests.parser_service.worker_process import TEMPO, RunningWorker
from tests.waiting import wait_for

pytestmark = [pytest.mark.browser, pytest.mark.processes, pytest.mark.django_db(transaction=True)]

TRAINING_SECONDS = 3600 if IS_FULL else 120
REASON = "Nobody names a room."


@pytest.fixture
def runs(transactional_db, world, shared_data, tmp_path) -> list[TrainingRun]:
    return train_three(world, shared_data, tmp_path / "cut")


@pytest.fixture
def worker(runs, tmp_path) -> Iterator[RunningWorker]:
    started = RunningWorker(tmp_path / "worker.log", tempo=1 if IS_FULL else TEMPO)
    yield started
    started.remove()
    print(started.log.read_text(encoding="utf-8"))


def test_a_reviewers_sitting_without_a_mouse(logged_in, live_server, runs, admin, worker):
    example, form = doubtful(runs)
    page = logged_in(admin).new_page()
    page.goto(f"{live_server.url}/w/home/results/")
    before = cell_of(page, runs[0]).inner_text()
    open_wrong_answers(page, runs)
    go_to(page, runs[0], example)
    tag_and_doubt(page, runs[0], example, form)
    take_from_the_queue(page, example)
    correct(page, example, form)
    freeze_anew(page, runs[0])
    again = retrain(page, runs[0])
    follow(page, place(page, "Results"), "Results")
    after = cell_of(page, again).inner_text()
    print(f"{again.parser}: {before.split()} → {after.split()}")
    assert after != before


def cell_of(page: Page, run: TrainingRun) -> Locator:
    """Return the figure of ``run`` on paraphrases."""
    return page.locator(f"a.accuracy[href*='run={run.pk}&'][href*='source=paraphrased']")


def open_wrong_answers(page: Page, runs: list[TrainingRun]) -> None:
    """Go from the figure of the first run to its wrong answers, and show the other runs beside."""
    skip_to_content(page)
    follow(page, cell_of(page, runs[0]), "Review")
    for run in runs[1:]:
        expect_focus(page, runs[0])
        page.keyboard.press("o")
        choose(page, page.locator("#review-add"), str(run.pk))
        page.keyboard.press("Tab")
        enter(page, "Review")
    expect(page.locator("[data-answer]")).to_have_count(len(runs))


def choose(page: Page, field: Locator, value: str) -> None:
    """Press an arrow until the ``field``, which has the focus, has ``value``."""
    expect(field).to_be_focused()
    for _ in range(field.locator("option").count()):
        if field.input_value() == value:
            return
        page.keyboard.press("ArrowDown")
    assert field.input_value() == value


def expect_focus(page: Page, run: TrainingRun) -> None:
    """The answer of ``run`` has the focus, and nothing is on its way."""
    expect(page.locator(f"#answer-{run.pk}")).to_be_focused()
    expect(page.locator("#list .htmx-request, .htmx-added, .htmx-settling")).to_have_count(0)


def go_to(page: Page, run: TrainingRun, example: Example) -> None:
    case = page.locator("#case")
    expect_focus(page, run)
    while (shown := case.get_attribute("data-case")) != str(example.pk):
        page.keyboard.press("j")
        expect(case).not_to_have_attribute("data-case", shown)
        expect_focus(page, run)


def tag_and_doubt(page: Page, run: TrainingRun, example: Example, form: str) -> None:
    """Tag the answer as one of a wrong label, and send the label to the work queue with the right form."""
    button = page.get_by_role("button", name="Wrong gold label")
    page.keyboard.press(button.get_attribute("data-digit"))
    expect(button).to_have_attribute("aria-pressed", "true")
    wait_for(lambda: Review.objects.by_people().exists(), "the answer is tagged")
    assert Review.objects.by_people().get().example_id == example.pk
    expect_focus(page, run)
    page.keyboard.press("d")
    page.keyboard.type(REASON)
    page.keyboard.press("Tab")
    choose(page, page.locator("#review-right"), form)
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    expect(page.locator("#review-said")).to_contain_text("as a label in doubt")
    expect_focus(page, run)


def take_from_the_queue(page: Page, example: Example) -> None:
    page.keyboard.press("q")
    arrive(page, "Queue")
    page.keyboard.press("j")
    enter(page, example.utterance)
    expect(page.locator("main")).to_contain_text(REASON)
    skip_to_content(page)
    follow(page, page.get_by_role("button", name="Take this item"), "Label audit")


def correct(page: Page, example: Example, form: str) -> None:
    expect(page.locator("#finding")).to_contain_text(REASON)
    page.keyboard.press("1")
    expect(page.locator("[data-audit-done]")).to_be_visible()
    paraphrase = Paraphrase.objects.filter(utterance=example.utterance).first()
    assert paraphrase.logical_form == form
    example.refresh_from_db()
    assert example.logical_form != form


def freeze_anew(page: Page, run: TrainingRun) -> None:
    follow(page, place(page, "Splits"), "Splits")
    while True:
        page.keyboard.press("j")
        row = page.locator("tr:focus")
        if row.locator("a.row-link").inner_text().strip() == run.split.name:
            break
    enter(page, run.split.name)
    expect(page.get_by_role("heading", name="A newer corpus exists")).to_be_visible()
    skip_to_content(page)
    follow(page, page.get_by_role("button", name="Freeze anew"), f"{run.split.name}-2")
    expect(page.locator("#split-changes")).to_contain_text("since it was frozen")


def retrain(page: Page, run: TrainingRun) -> TrainingRun:
    """Start the configuration of ``run`` on the new split and wait until it has succeeded. Returns that run."""
    button = page.get_by_role("button", name=f"Retrain run {run.pk} on this split")
    expect(button).to_be_visible()
    skip_to_content(page)
    tab_to(page, button)
    page.keyboard.press("Enter")
    arrive_at(page, page.locator("#run-state"))
    expect(page.locator("#run-state .status").first).to_have_text(
        "succeeded", timeout=1000 * TRAINING_SECONDS
    )
    again = TrainingRun.objects.latest("pk")
    assert (again.parser, again.split.name) == (run.parser, f"{run.split.name}-2")
    return again
