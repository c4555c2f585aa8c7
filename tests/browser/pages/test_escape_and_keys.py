"""On every page: Escape, input methods, keyboards of any layout, and the focus where a form comes back."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from django.test import Client
from playwright.sync_api import Page, Route, expect

from annotations.labelling.collecting import collect
from annotations.models import User
from tests.browser.arriving import ENHANCED
from tests.filled_world import leave_traces
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import API_ROUTES
from tests.gpsr_site.routes.policy import POLICY, YES
from tests.sample_world import SampleWorld

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

TYPING = Path(__file__).resolve().parents[3] / "static" / "src" / "typing.js"


@pytest.fixture
def filled(sample, annotator, admin) -> SampleWorld:
    leave_traces(sample.world, annotator, admin)
    User.objects.filter(pk=admin.pk).update(is_superuser=True)
    return replace(sample, form=sample.world.logical_forms.first())


@pytest.fixture
def pages(filled, adam, page_of, admin, live_server) -> Callable[[bytes], list[str]]:
    """Lists the addresses of all pages in which something stands."""
    names = {rule.name for rule in POLICY if (rule.method, rule.admin) == ("get", YES)}
    paths = [address(name, filled) for name in sorted(names - set(API_ROUTES))]
    texts = {path: text_of(adam, path) for path in paths}

    def pages_with(what: bytes) -> list[str]:
        return [path for path, text in texts.items() if what in text and b"<h1" in text]

    return pages_with


def text_of(client: Client, path: str) -> bytes:
    answer = client.get(path, follow=True)
    return b"" if answer.has_header("Content-Disposition") else b"".join(answer)


def visit(page: Page, url: str) -> None:
    page.goto(url, wait_until="domcontentloaded")
    expect(page.locator(f":is({ENHANCED}):not([data-ready])")).to_have_count(0)


# Opens every fold and menu, types into it, and says which does not close by Escape, closes by the Escape of an input
# method, loses its text, or leaves the focus nowhere.
CLOSE_ALL = """async () => {
  const faults = [];
  const escape = {key: "Escape", code: "Escape", bubbles: true, cancelable: true};
  const press = (target, more) =>
    target.dispatchEvent(new KeyboardEvent("keydown", {...escape, ...more}));
  const isShown = (element) => element?.checkVisibility({visibilityProperty: true});
  for (const fold of document.querySelectorAll("details")) {
    const name = fold.outerHTML.slice(0, 120).replace(/\\s+/g, " ");
    const summary = fold.querySelector(":scope > summary");
    const around = [...document.querySelectorAll("details")].filter((each) => each.contains(fold));
    around.forEach((each) => (each.open = true));
    if (!isShown(summary)) continue;
    fold.open = true;
    await new Promise((resolve) => setTimeout(resolve));
    const isFree = (each) => each.checkVisibility() && !each.disabled && !each.readOnly;
    const own = (each) => each.closest("details") === fold && isFree(each);
    const field = [...fold.querySelectorAll("textarea, input[type=text]")].find(own);
    const inside = field ?? [...fold.querySelectorAll("a[href], button, input, select")].find(own) ?? summary;
    inside.focus();
    if (field) field.value = "kept";
    press(inside, {isComposing: true});
    press(inside, {keyCode: 229});
    if (!fold.open) faults.push(`closed by an input method: ${name}`);
    press(inside);
    if (fold.open) faults.push(`stays open: ${name}`);
    if (field && field.value !== "kept") faults.push(`loses its text: ${name}`);
    const isNowhere = document.activeElement === document.body || !isShown(document.activeElement);
    if (isNowhere) faults.push(`leaves the focus nowhere: ${name}`);
  }
  return faults;
}"""


def test_escape_closes_every_fold_and_menu_and_loses_nothing(pages, page_of, admin, live_server):
    page = page_of(admin)
    paths = pages(b"<main")
    assert len(paths) > 60
    faults = {}
    for path in paths:
        visit(page, f"{live_server.url}{path}")
        if found := page.evaluate(CLOSE_ALL):
            faults[path] = found
    assert faults == {}


def test_a_legend_closes_by_escape_and_comes_back(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/results/")
    legend, button = page.locator(".legend-card"), page.locator(".legend > button")
    button.focus()
    expect(legend).to_be_visible()
    page.keyboard.press("Escape")
    expect(legend).to_be_hidden()
    expect(button).to_be_focused()
    button.blur()
    button.hover()
    expect(legend).to_be_visible()
    legend.hover()  # one can go to it, too
    expect(legend).to_be_visible()
    page.keyboard.press("Escape")
    expect(legend).to_be_hidden()
    page.mouse.move(0, 0)
    button.hover()
    expect(legend).to_be_visible()


def test_escape_leaves_the_text_of_a_search(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/commands/")
    search = page.locator("[data-search]")
    search.fill("kitchen")
    search.press("Escape")
    expect(search).to_have_value("kitchen")
    expect(search).not_to_be_focused()


def test_dialogs_close_by_escape(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/commands/")
    page.keyboard.press("?")
    expect(page.locator("#keys")).to_be_visible()
    page.keyboard.press("Escape")
    expect(page.locator("#keys")).to_be_hidden()


# Presses a key on the page and says what it does: what is clicked or sent, where the focus goes, and whether the
# browser is left out of it. Nothing of it is done.
PRESS = """async ({key, code, ...more}) => {
  const done = [];
  const note = (event) => {
    event.preventDefault();
    event.stopImmediatePropagation();
    done.push(`${event.type} ${event.target.outerHTML.slice(0, 160)}`);
  };
  for (const type of ["click", "submit"]) window.addEventListener(type, note, true);
  document.activeElement.blur();
  const event = new KeyboardEvent("keydown", {key, code, bubbles: true, cancelable: true, ...more});
  document.body.dispatchEvent(event);
  await new Promise((resolve) => setTimeout(resolve, 20));
  const focus = document.activeElement.outerHTML.slice(0, 160);
  const isOpen = Boolean(document.querySelector("dialog[open]"));
  for (const type of ["click", "submit"]) window.removeEventListener(type, note, true);
  document.querySelectorAll("dialog[open]").forEach((dialog) => dialog.close());
  document.querySelectorAll("details[data-menu][open]").forEach((menu) => (menu.open = false));
  const escape = {key: "Escape", code: "Escape", bubbles: true, cancelable: true};
  document.body.dispatchEvent(new KeyboardEvent("keydown", escape));
  return {done, focus, isOpen, isOurs: event.defaultPrevented};
}"""
DECLARED = """() => [...new Set([
  ...[...document.querySelectorAll("#keys kbd")].map((each) => each.textContent.trim()),
  ...[...document.querySelectorAll("[aria-keyshortcuts]")].map((each) => each.ariaKeyShortcuts),
])].filter((key) => /^[a-z1-9]$/.test(key))"""
RUSSIAN = dict(zip("qwertyuiopasdfghjklzxcvbnm", "йцукенгшщзфывапролдячсмить", strict=True))
AZERTY = dict(zip("123456789", "&é\"'(-è_ç", strict=True))
PAUSE = {"/w/home/audit/": 270}  # milliseconds: two presses in a row are one decision there


def layouts(key: str) -> dict[str, dict[str, object]]:
    """Return what a keyboard writes when somebody presses a key, by its layout."""
    if key.isdigit():
        return {"AZERTY": {"key": AZERTY[key], "code": f"Digit{key}"}}
    place = f"Key{key.upper()}"
    return {
        "Caps Lock": {"key": key.upper(), "code": place},
        "Russian": {"key": RUSSIAN[key], "code": place},
        "Dvorak": {"key": key, "code": "KeyQ" if key != "q" else "KeyX"},
    }


def keys_of(page: Page) -> list[str]:
    declared: list[str] = page.evaluate(DECLARED)
    return sorted(declared)


def test_keys_obey_on_keyboards_of_any_layout_and_in_no_composition(
    pages, filled, page_of, admin, live_server
):
    collect(filled.world, ["find the tea now", "find the tea please"], by=admin)
    page, faults, pressed = page_of(admin), [], 0
    keyed = [*pages(b"<h3>On this page</h3>"), "/w/home/label/", "/w/home/commands/"]
    assert len(keyed) > 5
    for path in keyed:
        visit(page, f"{live_server.url}{path}")
        page.wait_for_load_state("networkidle")
        for key in keys_of(page):
            place = f"Digit{key}" if key.isdigit() else f"Key{key.upper()}"
            usual = {"key": key, "code": place}
            press(page, usual)  # what it opens stays open
            page.wait_for_timeout(PAUSE.get(path, 0))
            plain = press(page, usual)
            for layout, event in layouts(key).items():
                page.wait_for_timeout(PAUSE.get(path, 0))
                if press(page, event) != plain:
                    faults.append((path, key, layout))
            if press(page, {**usual, "isComposing": True})["isOurs"]:
                faults.append((path, key, "in a composition"))
            pressed += bool(plain["isOurs"] or plain["done"])
    assert faults == []
    assert pressed > 40


def press(page: Page, event: dict[str, object]) -> dict[str, object]:
    done: dict[str, object] = page.evaluate(PRESS, event)
    return done


# Empties the texts of the form at a place, and says whether it can be sent so.
EMPTY = """(at) => {
  const form = [...document.querySelectorAll("main form[method=post]")][at];
  if (!form || form.matches("[hx-post], [data-label-answer], [data-label-mend]")) return false;
  const texts = "textarea[name], input:is([type=text], [type=password])[name]";
  const fields = [...form.elements].filter((field) => field.matches(texts));
  fields.forEach((field) => (field.value = ""));
  form.noValidate = true;
  return fields.length > 0;
}"""
SEND = """(at) => {
  const form = [...document.querySelectorAll("main form[method=post]")][at];
  form.requestSubmit(form.querySelector("button:not([type=button])"));
}"""
FAULTY = "main .field .errorlist, main [aria-invalid=true]"
HAS_FOCUS = """() => {
  const focused = document.activeElement;
  const first = document.querySelector(".field:has(.errorlist), [aria-invalid=true]");
  return first === focused || first.contains(focused);
}"""


def test_a_form_that_comes_back_has_the_focus_in_its_first_wrong_field(
    pages, page_of, admin, live_server
):
    page, wrong, seen = page_of(admin), [], set()
    for path in pages(b'method="post"'):
        visit(page, f"{live_server.url}{path}")
        for at in range(page.locator("main form[method=post]").count()):
            visit(page, f"{live_server.url}{path}")
            if not page.evaluate(EMPTY, at):
                continue
            with page.expect_navigation(wait_until="domcontentloaded"):
                page.evaluate(SEND, at)
            expect(page.locator(f":is({ENHANCED}):not([data-ready])")).to_have_count(0)
            if page.locator(FAULTY).count():
                seen.add(path)
                if not page.evaluate(HAS_FOCUS):
                    focused = page.evaluate("document.activeElement.outerHTML.slice(0, 99)")
                    wrong.append((path, at, focused))
    assert wrong == []
    assert len(seen) > 15


# Gives the focus to the button of the form at a place, as somebody has it who tabs there. Says no where none can be
# pressed.
TAB_TO = """(at) => {
  const form = [...document.querySelectorAll("main form[method=post]")][at];
  if (!form || form.matches("[hx-post], [data-label-answer], [data-label-mend]")) return false;
  for (let fold = form.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
  const button = form.querySelector("button:not([type=button]):not([disabled])");
  if (!button?.checkVisibility()) return false;
  form.noValidate = true;
  window.isLeft = true;
  addEventListener("submit", (event) => (document.title = event.defaultPrevented ? "stays" : "goes"));
  button.focus();
  return document.activeElement === button;
}"""
ANSWERED = (
    "() => document.title === 'stays' || (!window.isLeft && document.readyState === 'complete')"
)
WHERE = """() => {
  const focused = document.activeElement;
  const isHere = focused.closest("main, dialog") && focused.checkVisibility();
  return isHere ? "" : focused.outerHTML.slice(0, 99);
}"""


def test_after_every_form_the_focus_is_in_what_one_goes_on_with(pages, page_of, admin, live_server):
    """Each form is sent from its button by Enter, and answered with the page on which it stands."""
    page, lost, sent, path = page_of(admin), [], 0, ""

    def answer_with_the_page(route: Route) -> None:
        nonlocal sent
        if route.request.method == "POST" and route.request.is_navigation_request():
            sent += 1
            route.continue_(method="GET", url=f"{live_server.url}{path}")
        else:
            route.fallback()

    page.route("**/*", answer_with_the_page)
    framed = set(pages(b'id="main"'))  # those of contributors and of the log-in have one form each
    for path in filter(framed.__contains__, pages(b'method="post"')):
        visit(page, f"{live_server.url}{path}")
        for at in range(page.locator("main form[method=post]").count()):
            if not page.evaluate(TAB_TO, at):
                continue
            page.keyboard.press("Enter")
            page.wait_for_function(ANSWERED)
            if page.title() == "stays":  # a script has sent it
                visit(page, f"{live_server.url}{path}")
                continue
            expect(page.locator(f":is({ENHANCED}):not([data-ready])")).to_have_count(0)
            page.wait_for_timeout(20)  # what is focused last comes after the scripts
            if where := page.evaluate(WHERE):
                lost.append((path, at, where))
    assert lost == []
    assert sent > 40


def test_save_and_next_leaves_the_focus_on_what_comes_next(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    visit(page, f"{live_server.url}/w/home/templates/{sample.template.pk}/")
    page.get_by_role("button", name="Save and next").press("Enter")
    page.wait_for_url(re.compile("/templates/new/|/coverage/"))
    expect(page.locator("#main:focus, #main :focus")).to_have_count(1)
