"""Every page by axe-core's rules and by keyboard, in both themes, signed in and out."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Page

from tests.browser.test_every_page import SETTLE, addresses

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

AXE = Path(__file__).resolve().parents[2] / "node_modules" / "axe-core" / "axe.min.js"
# Two frames later, also what waits for the sizes of things is done.
GRAVE = """async (rules) => {
  for (const _ of [1, 2]) await new Promise(requestAnimationFrame);
  const only = rules && {runOnly: {type: "rule", values: rules}};
  const {violations} = await axe.run(document, {resultTypes: ["violations"], ...only});
  return violations
    .filter(({impact}) => ["serious", "critical"].includes(impact))
    .map(({id, nodes}) => `${id}: ` + nodes.map(
      (node) => `${node.html.slice(0, 160)} [${node.any[0]?.message ?? ""}]`).join("; "));
}"""
COLOUR_AND_SIZE = [
    "color-contrast",
    "link-in-text-block",
    "scrollable-region-focusable",
    "target-size",
]
WIDE, NARROW = ({"width": width, "height": 800} for width in (1280, 390))

# Controls that Tab passes over, and those that look the same with the focus and without it: they,
# what they stand in and what stands in that.
CONTROLS = """() => [...document.querySelectorAll("a[href], button, input, select, textarea, summary")]
  .filter((element) => element.type !== "hidden" && !element.disabled)
  .filter((element) => element.checkVisibility({visibilityProperty: true}))"""
PASSED_OVER = f"""() => ({CONTROLS})()
  .filter((element) => element.tabIndex !== 0)
  .map((element) => element.outerHTML.slice(0, 160))"""
UNMARKED = f"""() => {{
  const look = (element) => [element, element.parentElement, element.parentElement.parentElement]
    .map((each) => getComputedStyle(each))
    .map((style) => [style.outline, style.boxShadow, style.backgroundColor, style.borderColor].join())
    .join();
  const looks_alike = (element) => {{
    document.activeElement.blur();
    const before = look(element);
    element.focus();
    return look(element) === before;
  }};
  return ({CONTROLS})().filter(looks_alike).map((element) => element.outerHTML.slice(0, 160));
}}"""


@pytest.fixture(scope="session")
def axe() -> str:
    """The source of axe-core; the tests are skipped without it."""
    if not AXE.exists():
        pytest.skip(f"needs axe-core, and there is none at {AXE.parent}: make install")
    return AXE.read_text(encoding="utf-8")


def faults(page: Page, axe: str, address: str) -> dict[str, list[str]]:
    """What keeps somebody from using the page at ``address``; empty where nothing does.

    In the dark theme and a narrow window, only the rules of colours and sizes are asked again. The
    debugger evaluates axe-core, which the page's content policy does not stop.
    """
    page.set_viewport_size(WIDE)
    page.emulate_media(color_scheme="light", reduced_motion="reduce")
    page.goto(address)
    page.wait_for_timeout(SETTLE)
    return {what: each for what, each in listed(page, axe).items() if each}


def listed(page: Page, axe: str) -> dict[str, list[str]]:
    page.evaluate(axe)
    light = page.evaluate(GRAVE, None)
    page.keyboard.press("Tab")  # from here on the browser shows where the focus is
    passed_over, unmarked = page.evaluate(PASSED_OVER), page.evaluate(UNMARKED)
    page.emulate_media(color_scheme="dark", reduced_motion="reduce")
    page.set_viewport_size(NARROW)
    page.wait_for_timeout(SETTLE)
    return {
        "light and wide": light,
        "dark and narrow": page.evaluate(GRAVE, COLOUR_AND_SIZE),
        "passed over by Tab": passed_over,
        "focus not to be seen": unmarked,
    }


def test_every_page_can_be_used_by_everybody(axe, sample, waiting_run, admin, page_of, live_server):
    page = page_of(admin)
    paths = [*addresses(sample), f"/w/home/runs/{waiting_run.pk}/", "/w/home/no-such-page/"]
    reports = {path: faults(page, axe, f"{live_server.url}{path}") for path in paths}
    assert {path: report for path, report in reports.items() if report} == {}


def test_so_can_the_pages_of_somebody_signed_out(axe, page, live_server, db):
    for path in ("/login/", "/no-such-page/"):
        assert faults(page, axe, f"{live_server.url}{path}") == {}, path


def test_what_is_looked_for_is_met_where_it_is(axe, page):
    page.set_content(
        """<html lang="en"><style>a {color: #ccc} button:focus {outline: none}</style>
        <main><h1>Bad</h1><a href="/" tabindex="-1">grey</a><button>no focus</button></main></html>"""
    )
    report = listed(page, axe)
    assert "color-contrast" in report["light and wide"][0]
    assert [len(each) for each in list(report.values())[2:]] == [1, 1]
