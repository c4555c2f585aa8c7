"""Runs are compared by keyboard alone: chosen, counted against each other, narrowed to a slice, and read."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect

from parser_service.models import Slice, TrainingRun
from parser_service.results.saving import save_slice as save_a_slice
from tests.browser.walking import enter, follow, skip_to_content, tab_to
from tests.sample_world import scored_run

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.fixture
def runs(sample) -> list[TrainingRun]:
    """A run with eight right answers, the one of the sample with the first three of them, and a third run."""
    better = scored_run(sample.world, sample.split, right=8, seed=1)
    return [better, sample.run, scored_run(sample.world, sample.split, "seq2seq", right=5)]


def test_a_comparison_from_the_results_to_the_wrong_answers(page_of, live_server, runs, reviewer):
    page = page_of(reviewer)
    page.goto(f"{live_server.url}/w/home/results/")
    skip_to_content(page)
    follow(page, page.get_by_role("button", name="Compare"), "Compare")
    choose(page, runs)
    expect_matrix(page, [["·", "5"], ["0", "·"]])
    expect(page.locator(".meaning")).to_contain_text(f"run {runs[0].pk}")

    narrow_to_paraphrases(page)
    expect_matrix(page, [["·", "2"], ["0", "·"]])
    save_slice(page)
    skip_to_content(page)
    follow(page, page.locator(".win-matrix a", has_text="2"), "Review")
    expect(page.locator("[data-answer]")).to_have_count(2)
    expect(page.locator("[data-review-place]")).to_have_text("No. 1 of 2")
    wrong, right = (page.locator(f"#answer-{run.pk}") for run in (runs[1], runs[0]))
    expect(wrong).to_be_focused()
    expect(wrong).to_contain_text("wrong")
    expect(right).to_contain_text("exact")


def test_a_slice_is_renamed_where_it_stands(page_of, live_server, sample, reviewer):
    save_a_slice(sample.world, "said by peple", "source=paraphrased")
    page = page_of(reviewer)
    page.goto(f"{live_server.url}/w/home/slices/")
    page.locator("summary", has_text="Rename").click()
    box = page.locator(".table-wrap")
    cut_off = box.evaluate("wrap => wrap.scrollHeight - wrap.clientHeight")
    assert cut_off <= 1, "the table cuts off what opens in it"
    page.get_by_label("Name", exact=True).fill("said by people")
    page.keyboard.press("Enter")
    expect(page.locator("main")).to_contain_text("said by people")
    assert Slice.objects.get().name == "said by people"


def choose(page: Page, runs: list[TrainingRun]) -> None:
    """The page compares the two best. Put one of them away, and find another of the same parser among all."""
    skip_to_content(page)
    tab_to(page, page.locator("[data-run-picker] > summary"))
    page.keyboard.press("Enter")
    tab_to(page, page.locator(f"#run-{runs[2].pk}:checked"))
    page.keyboard.press("Space")
    tab_to(page, page.get_by_label("Find a run"), "Shift+Tab")
    page.keyboard.type("nearest")
    expect(page.locator(f"#run-{runs[2].pk}")).to_be_hidden()
    tab_to(page, page.locator(f"#run-{runs[1].pk}"))
    page.keyboard.press("Space")
    tab_to(page, page.get_by_role("button", name="Compare", exact=True))
    enter(page, "Compare")


def expect_matrix(page: Page, rows: list[list[str]]) -> None:
    """On how many examples the run of the row is right and that of the column is wrong."""
    cells = [cell for row in rows for cell in row]
    expect(page.locator(".win-matrix td")).to_have_text(cells)


def narrow_to_paraphrases(page: Page) -> None:
    """Set a filter. The address of the page has led to its content, so that the next Tab begins there."""
    tab_to(page, page.get_by_label("Source"))
    page.keyboard.type("para")
    tab_to(page, page.get_by_role("button", name="Compare", exact=True))
    enter(page, "Compare")
    expect(page.locator(".filter-chip")).to_contain_text("Source")
    assert "=&" not in f"{page.url}&", "a filter that is not set stands in the address"


def save_slice(page: Page) -> None:
    """Keep the filters under a name; the table of slices then has them."""
    tab_to(page, page.get_by_label("Save these filters as a slice"))
    page.keyboard.type("said by people")
    enter(page, "Compare")
    expect(page.locator("main")).to_contain_text("said by people")
    assert Slice.objects.get().name == "said by people"
