"""What one comes to Review and Compare for: how many clicks away it is, and that it is seen without scrolling."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, Page, expect

from parser_service.models import Evaluation, TrainingRun
from tests.browser.arriving import arrive
from tests.sample_world import scored_run

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

WIDE = {"width": 1280, "height": 800}
ZOOMED = {"width": 640, "height": 400}  # a window of 1280 by 800 at 200 %
FIRST = 350  # pixels
ANSWER = {"annotated": ".review-label .lf", "answer": ".review-answer .lf", "said": ".review-text"}

# Whether nothing lies over the middle of an element.
IS_ON_TOP = """element => {
  const box = element.getBoundingClientRect();
  const top = document.elementFromPoint(box.x + Math.min(box.width / 2, 40), box.y + box.height / 2);
  return element === top || element.contains(top);
}"""


@pytest.fixture
def runs(sample) -> list[TrainingRun]:
    """A run with eight right answers, and the newest, which is the worst; that of the sample has three."""
    better = scored_run(sample.world, sample.split, right=8, seed=1)
    return [better, sample.run, scored_run(sample.world, sample.split, right=1, seed=2)]


def overview(page: Page, url: str) -> Page:
    page.goto(f"{url}/w/home/")
    arrive(page, "Overview")
    return page


def click(*places: Locator) -> int:
    """Click on each of ``places``. Returns how many clicks that takes."""
    for each in places:
        each.click()
    return len(places)


def expect_first_wrong_answer(page: Page, run: TrainingRun, lowest: int) -> None:
    """The first wrong answer of ``run`` ends above ``lowest``, without scrolling, and nothing lies over it."""
    arrive(page, "Review")
    wrong = run.predictions.filter(is_exact_match=False).order_by("example_id")
    first = wrong.values_list("example_id", flat=True)[0]
    expect(page.locator("#case")).to_have_attribute("data-case", str(first))
    expect(page.locator(f"#answer-{run.pk}")).to_contain_text("wrong")
    assert page.evaluate("scrollY") == 0
    for what, selector in ANSWER.items():
        part = page.locator(selector).first
        box = part.bounding_box()
        assert box["y"] + box["height"] <= lowest, what
        assert part.evaluate(IS_ON_TOP), what


def test_the_first_wrong_answer_of_the_best_run_is_two_clicks_away(
    page_of, live_server, runs, reviewer
):
    page = overview(page_of(reviewer, viewport=WIDE), live_server.url)
    clicks = click(page.locator("#rail").get_by_role("link", name="Review"))
    assert clicks <= 2
    expect_first_wrong_answer(page, runs[0], FIRST)


def test_so_it_is_in_a_window_at_twice_the_size(page_of, live_server, runs, reviewer):
    page = overview(page_of(reviewer, viewport=ZOOMED), live_server.url)
    clicks = click(
        page.get_by_role("button", name="Pages"),
        page.locator("#rail").get_by_role("link", name="Review"),
    )
    assert clicks <= 2
    expect_first_wrong_answer(page, runs[0], ZOOMED["height"])


LONG_TEXT = "could you please be so kind as to go to the kitchen and then " * 12
STEP = (
    '( bring ( lambda $1 e ( and ( is_a $1 " <object> " ) ( at $1 " <location> " ) ) ) " <name> " )'
)
LAST = '( go " <room> " )'


@pytest.fixture
def long_case(runs) -> TrainingRun:
    """The best run, whose first wrong answer is about a very long utterance, and differs in its last step."""
    wrong = runs[0].predictions.filter(is_exact_match=False).order_by("example_id").first()
    steps = " ".join([STEP] * 8)
    wrong.example.utterance = LONG_TEXT
    wrong.example.logical_form = f"( sequence {steps} {STEP} )"
    wrong.example.save()
    wrong.logical_form = f"( sequence {steps} {LAST} )"
    wrong.save()
    return runs[0]


# How far down the first difference of the answer is seen, within the lines that its form has.
DIFFERENCE = """() => {
  const code = document.querySelector(".review-answer .lf > code");
  const mark = code.querySelector("mark, ins, del").getBoundingClientRect();
  const lines = code.getBoundingClientRect();
  return mark.top >= lines.top - 1 && mark.bottom <= lines.bottom + 2 ? mark.bottom : Infinity;
}"""


@pytest.mark.parametrize(("window", "lowest"), [(WIDE, FIRST), (ZOOMED, ZOOMED["height"])])
def test_a_very_long_utterance_leaves_the_difference_in_sight_and_can_be_read(
    window, lowest, page_of, live_server, long_case, reviewer
):
    page = page_of(reviewer, viewport=window)
    page.goto(f"{live_server.url}/w/home/review/?run={long_case.pk}&outcome=wrong")
    expect(page.locator(f"#answer-{long_case.pk}")).to_be_focused()
    assert page.evaluate(DIFFERENCE) <= lowest
    text, show_all = page.locator(".review-text"), page.locator("[data-show-all]")
    assert text.evaluate("text => text.scrollHeight > text.clientHeight")
    expect(show_all).to_have_attribute("aria-expanded", "false")
    page.keyboard.press("v")
    expect(show_all).to_have_attribute("aria-expanded", "true")
    assert text.evaluate("text => text.scrollHeight <= text.clientHeight")
    page.reload()
    expect(show_all).to_have_attribute("aria-expanded", "false")
    show_all.click()
    show_all.click()
    assert text.evaluate("text => text.scrollHeight > text.clientHeight")


def test_a_short_utterance_has_no_button_for_more(page_of, live_server, runs, reviewer):
    page = page_of(reviewer, viewport=WIDE)
    page.goto(f"{live_server.url}/w/home/review/")
    expect(page.locator(f"#answer-{runs[0].pk}")).to_be_focused()
    expect(page.locator("[data-show-all]")).to_be_hidden()


def test_the_card_of_the_best_run_leads_there_too(page_of, live_server, runs, reviewer):
    Evaluation.objects.update(test_source="mixed")  # what the scores of the sample count
    page = overview(page_of(reviewer, viewport=WIDE), live_server.url)
    assert click(page.locator(".best-wrong").first) == 1
    expect_first_wrong_answer(page, runs[0], FIRST)


def test_two_runs_are_compared_three_clicks_from_the_overview(page_of, live_server, runs, reviewer):
    page = overview(page_of(reviewer, viewport=WIDE), live_server.url)
    clicks = click(
        page.locator("#rail").get_by_role("link", name="Results"),
        page.locator("main").get_by_role("link", name="Compare", exact=True),
    )
    assert clicks <= 3
    arrive(page, "Compare")
    expect(page.locator(".win-matrix")).to_be_visible()
    ticked = page.locator("[data-run-picker] input:checked")
    expect(ticked).to_have_count(2)
    assert [each.get_attribute("value") for each in ticked.all()] == [
        str(runs[0].pk),
        str(runs[1].pk),
    ]


def test_filters_fold_away_behind_one_button(page_of, live_server, runs, reviewer):
    page = page_of(reviewer, viewport=WIDE)
    page.goto(f"{live_server.url}/w/home/review/")
    expect(page.locator(f"#answer-{runs[0].pk}")).to_be_focused()
    filters = page.get_by_role("form", name="Filter answers")
    expect(filters).to_be_hidden()
    page.keyboard.press("f")
    expect(filters.get_by_label("Search")).to_be_focused()
    filters.get_by_label("Source").select_option("paraphrased")
    expect(page.locator(".filter-chip")).to_have_count(3)
    expect(page.locator(".filter-chip", has_text="Source")).to_be_visible()
    page.keyboard.press("Escape")
    expect(filters).to_be_hidden()
    expect(page.locator(".review-filters > summary")).to_be_focused()


def test_on_a_phone_the_categories_are_a_bar_at_the_bottom(page_of, live_server, runs, reviewer):
    page = page_of(reviewer, viewport={"width": 390, "height": 800})
    page.goto(f"{live_server.url}/w/home/review/")
    arrive(page, "Review")
    categories = page.get_by_role("form", name="Tag the answer")
    box = categories.bounding_box()
    assert box["y"] + box["height"] == pytest.approx(800, abs=1) and box["height"] < 60
    last = categories.get_by_role("button").last
    last.click()
    expect(last).to_have_attribute("aria-pressed", "true")
    page.get_by_role("button", name="Pages").click()
    expect(page.locator("#rail").get_by_role("link", name="Review")).to_be_visible()
