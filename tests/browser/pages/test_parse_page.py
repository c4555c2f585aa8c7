"""Parse opens on what one came for: the plan and what the robot says, on the first screen, and both to be copied."""

from __future__ import annotations

import json
import re

import pytest
from playwright.sync_api import Locator, Page, expect

from annotations.models import Command, LogicalForm
from parser_service.runs.promoting import promote
from tests.browser.arriving import wait_for_swap
from tests.browser.faults import narrow_and_dark, only_faults, wide_and_light
from tests.browser.variants import NARROW_DARK, SIZES, VARIANTS, WIDE_LIGHT, Variant
from tests.browser.walking import tab_to
from tests.parser_service.live_server import parse_server  # noqa: F401
from tests.parser_service.served import make_home, name_umbrella, trained_run

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

SAID = "bring me the red cup"
LONG = "please be so kind as to look whether somebody can bring me the red cup " + "x" * 90
OPEN = {"pages": "parse/?text={}", "several": "parse/together/?command1={}&command2=find the bowl"}
BOTTOM_BAR = 52  # of a phone


@pytest.fixture
def open_page(transactional_db, world, annotator, logged_in, live_server, parse_server):  # noqa: F811
    """Opens a page of a world with a parser that answers, in a window."""
    promote(trained_run(make_home(world)), None)
    form = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
    Command.objects.create(
        world=world,
        logical_form=LogicalForm.objects.create(
            world=world, text=form, head_predicate="bring", depth=3, length=9
        ),
        anonymized_text="bring me the <object>",
        length=4,
        position=0,
    )
    parse_server.update()

    def open_it(path: str, variant: Variant = VARIANTS[0], without_clipboard: bool = False) -> Page:
        page = logged_in(annotator, variant).new_page()
        if without_clipboard:  # as a browser is without HTTPS
            page.add_init_script(
                "Object.defineProperty(navigator, 'clipboard', {value: undefined})"
            )
        page.goto(f"{live_server.url}/w/home/{path}")
        return page

    return open_it


def bottom(part: Locator) -> float:
    box = part.bounding_box()
    assert box is not None
    return box["y"] + box["height"]


def top(part: Locator) -> float:
    box = part.bounding_box()
    assert box is not None
    return box["y"]


@pytest.mark.parametrize("address", OPEN.values(), ids=OPEN.keys())
@pytest.mark.parametrize("text", [SAID, LONG], ids=["short", "long"])
def test_plan_and_sentence_are_on_the_first_screen(open_page, address, text):
    for variant in VARIANTS[::2]:
        page = open_page(address.format(text), variant)
        spoken, steps = page.locator(".plan-spoken"), page.locator(".plan .plan-steps > li")
        expect(spoken).to_be_visible()
        is_phone = variant.width < 800
        end = variant.height - BOTTOM_BAR * is_phone
        assert page.evaluate("scrollY") == 0
        assert bottom(spoken) <= end
        assert bottom(steps.first if is_phone else steps.last) <= end
        others = page.locator("main article.card:not(.plan)")
        assert all(top(each) >= bottom(page.locator(".plan")) for each in others.all())
        assert page.evaluate("document.documentElement.scrollWidth") <= variant.width


def test_one_click_on_an_example_fills_and_parses(open_page, world):
    name_umbrella(world)
    for variant in VARIANTS[::2]:
        page = open_page("parse/", variant)
        groups = page.locator("[data-suggestions] legend").all_inner_texts()
        assert groups == ["Commands of this world", "Texts of the paper"]
        chip = page.locator(".suggestion", has_text=SAID)
        chip.click()
        expect(page.get_by_label("Utterance")).to_have_value(SAID)
        expect(page.locator(".plan-spoken")).to_contain_text("red cup")
        expect(page).to_have_url(re.compile("text=bring"))
        assert (chip.bounding_box() or {})["height"] >= 24


def test_what_a_page_was_asked_is_copied_by_keyboard_and_said(open_page):
    page = open_page(f"parse/?text={SAID}")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    expect(page.locator(".plan-spoken")).to_be_visible()
    note = page.locator(".plan .copy-note")
    expect(note).to_have_attribute("role", "status")
    tab_to(page, page.get_by_role("button", name="Copy plan"))
    page.keyboard.press("Enter")
    expect(note).to_have_text("Copied")
    plan = json.loads(page.evaluate("navigator.clipboard.readText()"))
    shown = page.locator(".plan .plan-steps > li").count()
    assert len(plan["steps"]) == shown and plan["version"] == 1
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.wait_for_function("async () => (await navigator.clipboard.readText()).startsWith('curl')")
    curl = page.evaluate("navigator.clipboard.readText()")
    assert "Bearer $TOKEN" in curl and f'{{"utterance": "{SAID}"}}' in curl
    expect(page.locator("#copied-curl")).to_be_hidden()


def test_where_a_browser_lets_no_page_copy_the_text_is_selected(open_page):
    for size in range(len(SIZES)):
        page = open_page(f"parse/?text={SAID}", VARIANTS[2 * size], without_clipboard=True)
        button = page.get_by_role("button", name="Copy as curl")
        button.focus()
        page.keyboard.press("Enter")
        field = page.get_by_label("The request for curl")
        expect(field).to_be_focused()
        expect(page.locator(".plan .copy-note")).to_have_text("Selected: press Ctrl+C")
        assert page.evaluate("getSelection().toString()") == field.input_value()
        assert (field.bounding_box() or {})["width"] > 300


def test_a_form_is_selected_where_it_cannot_be_copied(open_page):
    page = open_page(f"parse/?text={SAID}", without_clipboard=True)
    form = page.locator("[data-form][data-tools]")
    form.get_by_role("button", name="Copy").click()
    expect(form.locator(".copy-note")).to_have_text("Selected: press Ctrl+C")
    assert page.evaluate("getSelection().toString()").startswith("bring(")
    wait_for_swap(page)


@pytest.mark.parametrize("address", [*OPEN.values(), "parse/?text="], ids=[*OPEN.keys(), "empty"])
def test_an_answer_can_be_used_by_everybody(open_page, axe, address):
    reports = {}
    for variant, look in ((NARROW_DARK, narrow_and_dark), (WIDE_LIGHT, wide_and_light)):
        page = open_page(address.format(SAID), variant)
        page.evaluate(axe)
        if not address.endswith("="):
            expect(page.locator(".plan-spoken")).to_be_visible()
        reports[f"{address} {variant}"] = look(page)
    assert only_faults(reports) == {}
