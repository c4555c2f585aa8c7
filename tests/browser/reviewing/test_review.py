"""Errors are read and tagged by keyboard alone."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect

from annotations.background.progress import UNWATCHED
from parser_service.models import Review
from parser_service.reviews.category_proposals import propose_for_run
from tests.sample_world import make_paraphrase, scored_run
from tests.waiting import wait_for

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.fixture
def runs(sample):
    other = scored_run(sample.world, sample.split, right=5, seed=1)
    for run in (sample.run, other):
        propose_for_run(run, frozenset(), UNWATCHED)
    return sample.run, other


@pytest.fixture
def review_page(page_of, live_server, runs, reviewer) -> Page:
    page = page_of(reviewer)
    chosen = "&".join(f"run={run.pk}" for run in runs)
    page.goto(f"{live_server.url}/w/home/review/?{chosen}&outcome=wrong")
    expect_answer(page, runs[0])
    return page


def expect_answer(page: Page, run) -> None:
    """The answer of ``run`` has the focus, and nothing is on its way."""
    expect(page.locator(f"#answer-{run.pk}")).to_be_focused()
    expect(page.locator("#list .htmx-request, .htmx-added, .htmx-settling")).to_have_count(0)


def examples_of(run) -> list[int]:
    rows = run.predictions.filter(is_exact_match=False).order_by("example_id")
    return list(rows.values_list("example_id", flat=True))


def tags() -> list[tuple[int, int, str]]:
    rows = Review.objects.by_people().filter(category__isnull=False).order_by("pk")
    return list(rows.values_list("run", "example", "category__code"))


def wait_for_tags(*wanted: tuple[int, int, str]) -> None:
    wait_for(lambda: tags() == list(wanted), f"the tags {wanted}")


def test_one_walks_through_the_errors_and_tags_them(review_page, runs):
    page, keys = review_page, review_page.keyboard
    first, second = examples_of(runs[0])[:2]
    expect(page.locator("#case")).to_have_attribute("data-case", str(first))
    keys.press("a")  # what is proposed
    expect(page.locator(f"#answer-{runs[0].pk}")).to_contain_text("tagged by you")
    wait_for_tags((runs[0].pk, first, "wrong_predicate"))
    expect_answer(page, runs[0])
    keys.press("8")
    wait_for_tags((runs[0].pk, first, "ill_formed"))
    expect(page.get_by_role("button", name="8 Ill-formed")).to_have_attribute(
        "aria-pressed", "true"
    )
    keys.press("z")
    wait_for_tags()
    expect_answer(page, runs[0])
    keys.press("j")
    expect(page.locator("#case")).to_have_attribute("data-case", str(second))
    expect_answer(page, runs[0])
    assert f"example={second}" in page.url
    page.reload()
    expect(page.locator("#case")).to_have_attribute("data-case", str(second))
    expect_answer(page, runs[0])
    keys.press("k")
    expect(page.locator("#case")).to_have_attribute("data-case", str(first))


def test_the_answer_of_the_other_run_is_tagged_and_noted(review_page, runs):
    page, keys = review_page, review_page.keyboard
    last = examples_of(runs[1])[0]
    while page.locator("#case").get_attribute("data-case") != str(last):
        shown = page.locator("#case").get_attribute("data-case")
        keys.press("j")
        expect(page.locator("#case")).not_to_have_attribute("data-case", shown)
        expect_answer(page, runs[0])
    keys.press("l")
    expect_answer(page, runs[1])
    assert f"focus={runs[1].pk}" in page.url
    expect(page.get_by_role("form", name="Tag the answer")).to_contain_text(f"run {runs[1].pk}")
    keys.press("-")  # the eleventh
    wait_for_tags((runs[1].pk, last, "outside_ontology"))
    expect_answer(page, runs[1])
    keys.press("i")
    keys.type("Is this so?")
    keys.press("Enter")
    expect_answer(page, runs[1])
    note = page.get_by_label(f"Your note on the answer of run {runs[1].pk}")
    expect(note).to_have_value("Is this so?")
    assert Review.objects.by_people().get().note == "Is this so?"
    keys.press("h")
    expect_answer(page, runs[0])


def test_only_where_the_runs_differ(review_page, runs):
    page, keys = review_page, review_page.keyboard
    differing = [key for key in examples_of(runs[0]) if key not in examples_of(runs[1])]
    keys.press("w")
    expect(page.locator("[data-review-place]")).to_have_text(f"No. 1 of {len(differing)}")
    expect(page.locator("#case")).to_have_attribute("data-case", str(differing[0]))
    expect_answer(page, runs[0])
    assert "differ=1" in page.url
    keys.press("w")  # the same example among all
    expect(page.locator("[data-review-place]")).to_have_text("No. 4 of 9")


def test_a_wrong_label_is_sent_to_the_queue(review_page, runs):
    page, keys = review_page, review_page.keyboard
    example = runs[0].split.examples.get(pk=examples_of(runs[0])[0])
    form = example.logical_form
    make_paraphrase(runs[0].world, "go", example.utterance, logical_form=form, grounded_form=form)
    keys.press("d")
    keys.type("It says go.")
    keys.press("Enter")
    expect(page.get_by_text("as a label in doubt")).to_be_visible()
    expect_answer(page, runs[0])
    reason = runs[0].world.work_items.get().reason
    assert reason.startswith("rene ") and reason.endswith(" It says go.")


def test_trees_and_candidates_stay_open_and_the_keys_are_listed(review_page, runs):
    page, keys = review_page, review_page.keyboard
    keys.press("t")
    expect(page.locator(f"#answer-{runs[0].pk} .tree svg")).to_be_visible()
    keys.press("j")
    expect(page.locator("#case")).to_have_attribute("data-case", str(examples_of(runs[0])[1]))
    expect_answer(page, runs[0])
    expect(page.locator(f"#answer-{runs[0].pk} .tree svg")).to_be_visible()
    keys.press("?")
    expect(page.get_by_role("dialog")).to_contain_text("accept what is proposed")


def press(page: Page, key: str, code: str, **more: bool) -> None:
    """Press a key as the layout of a keyboard has it: what it writes, and where it lies."""
    event = {"key": key, "code": code, "bubbles": True, "cancelable": True, **more}
    page.evaluate(
        "event => document.activeElement.dispatchEvent(new KeyboardEvent('keydown', event))", event
    )


@pytest.mark.parametrize(
    ("key", "code", "category"),
    [
        ("&", "Digit1", "1"),  # AZERTY
        ("-", "Digit6", "6"),
        (")", "Minus", "-"),
        ("+", "Digit1", "1"),  # Czech
        ("ß", "Minus", "-"),  # German
        ("-", "Slash", "-"),
        ("8", "Numpad8", "8"),
    ],
)
def test_categories_are_tagged_on_keyboards_of_any_layout(review_page, key, code, category):
    press(review_page, key, code)
    button = review_page.locator(f'[data-review-palette] [data-digit="{category}"]')
    expect(button).to_have_attribute("aria-pressed", "true")


@pytest.mark.parametrize(
    ("key", "code", "more"),
    [
        ("J", "KeyJ", {}),  # Caps Lock
        ("j", "KeyJ", {"shiftKey": True}),  # and Shift with it is none of it: see below
        ("о", "KeyJ", {}),  # Russian
        ("ξ", "KeyJ", {}),  # Greek
        ("j", "KeyC", {}),  # Dvorak
    ],
)
def test_letters_count_as_they_are_printed_or_else_by_their_place(
    review_page, runs, key, code, more
):
    first, second = examples_of(runs[0])[:2]
    press(review_page, key, code, **more)
    wanted = first if more else second
    expect_answer(review_page, runs[0])
    expect(review_page.locator("#case")).to_have_attribute("data-case", str(wanted))


def test_the_enter_that_ends_a_composition_sends_no_note(review_page):
    page = review_page
    page.keyboard.press("i")
    note = page.locator("[data-note]:focus")
    note.fill("へや")
    press(page, "Enter", "Enter", isComposing=True)
    press(page, "Process", "Enter", keyCode=229)
    press(page, "Escape", "Escape", isComposing=True)
    expect(note).to_have_value("へや")
    expect(note).to_be_focused()
    assert not Review.objects.by_people().exists()
    page.keyboard.press("Enter")
    wait_for(lambda: Review.objects.by_people().exists(), "the note is stored")
    assert Review.objects.by_people().get().note == "へや"
