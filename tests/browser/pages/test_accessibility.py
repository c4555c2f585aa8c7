"""What opens on a page, and what a save answers, by axe-core's rules; and those rules themselves."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect

from annotations.labelling.audit_findings import store_findings
from annotations.labelling.collecting import collect
from annotations.models import SemanticTemplate
from tests.browser.faults import (
    COLOUR_AND_SIZE,
    SETTLED,
    Faults,
    broken_rules,
    in_place,
    only_faults,
    wide_and_light,
)
from tests.browser.tree import tree_faults
from tests.browser.variants import NARROW_DARK, WIDE_LIGHT
from tests.browser.writing import open_editor, save_button, write
from tests.doubted_labels import doubt, say

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def open_keys(page: Page, url: str) -> None:
    page.goto(f"{url}/w/home/")
    page.keyboard.press("?")
    expect(page.locator("#keys")).to_be_visible()


def open_log_in(page: Page, url: str) -> None:
    open_editor(page, url)
    page.context.clear_cookies(name="sessionid")
    write(page, "go home", "(go {room})")
    page.get_by_role("button", name="Log in again").click()
    expect(page.locator("#log-in-again")).to_be_visible()


def open_menus(page: Page, url: str) -> None:
    page.goto(f"{url}/w/home/")
    for menu in page.locator("[data-menu]").all():
        menu.evaluate("menu => { menu.open = true; }")


def open_completion(page: Page, url: str) -> None:
    open_editor(page, url)
    page.get_by_role("textbox", name="Pattern").press_sequentially("$vb")
    expect(page.locator(".cm-tooltip-autocomplete")).to_contain_text("find | locate")


def open_problems(page: Page, url: str) -> None:
    open_editor(page, url)
    write(page, "$vbfind the {kobject}", "(fnd (λ$1:e (is_a $1 {kobject})))")
    expect(page.get_by_role("button", name="Write find for fnd")).to_be_visible()


def open_merge(page: Page, url: str) -> None:
    row = SemanticTemplate.objects.first()
    open_editor(page, url, str(row.pk))
    page.get_by_role("textbox", name="Pattern").fill("find my $object")
    SemanticTemplate.objects.filter(pk=row.pk).update(pattern="find a $object", version=2)
    save_button(page).click()
    expect(page.get_by_role("heading", name="Merge two changes")).to_be_visible()


def open_label_panel(key: str, field: str):
    def open_panel(page: Page, url: str) -> None:
        page.goto(f"{url}/w/home/label/")
        expect(page.locator("[data-label-page][data-ready]")).to_have_count(1)
        page.keyboard.press(key)
        expect(page.get_by_role("textbox", name=field)).to_be_visible()

    return open_panel


def open_written_form(page: Page, url: str) -> None:
    page.goto(f"{url}/w/home/audit/")
    expect(page.locator("[data-audit-page][data-ready]")).to_have_count(1)
    page.keyboard.press("e")
    expect(page.get_by_role("textbox", name="Logical form")).to_be_focused()


OPENED = {
    "the list of keys": open_keys,
    "menus": open_menus,
    "completions": open_completion,
    "problems and repairs": open_problems,
    "two changes to merge": open_merge,
    "a form to write": open_label_panel("e", "Logical form"),
    "a dispute": open_label_panel("d", "Why is it disputed?"),
    "a name to mend": open_label_panel("m", "The words"),
    "a correction to write": open_written_form,
    "the log-in over a page": open_log_in,
}


def faults_in_place(page: Page) -> Faults:
    """What is wrong in a wide light window, and with the colours and sizes of the same in a narrow dark one."""
    wide = {**in_place(page), **tree_faults(page)}
    page.set_viewport_size(NARROW_DARK.size)
    page.emulate_media(color_scheme="dark")
    page.evaluate(SETTLED)
    return {**wide, "narrow and dark": broken_rules(page, COLOUR_AND_SIZE)["axe"]}


def test_what_opens_on_a_page_can_be_used_by_everybody(axe, sample, admin, page_of, live_server):
    collect(sample.world, ["bring me the tea"])
    store_findings(sample.world, [doubt(say(sample.world, "how many girls"))])
    page = page_of(admin, variant=WIDE_LIGHT)
    page.add_init_script(axe)
    reports = {}
    for what, open_it in OPENED.items():
        page.set_viewport_size(WIDE_LIGHT.size)
        page.emulate_media(color_scheme="light")
        open_it(page, live_server.url)
        reports[what] = faults_in_place(page)
    assert only_faults(reports) == {}


def test_so_can_the_sheet_of_pages_in_a_narrow_window(axe, sample, admin, page_of, live_server):
    page = page_of(admin, variant=NARROW_DARK)
    page.add_init_script(axe)
    page.goto(f"{live_server.url}/w/home/")
    page.get_by_role("button", name="Pages").click()
    expect(page.locator("#rail a").first).to_be_visible()
    assert only_faults({"the sheet": broken_rules(page)}) == {}


def test_what_is_looked_for_is_met_where_it_is(axe, page):
    page.add_init_script(axe)
    page.goto(
        """data:text/html,<html lang="en"><style>a {color: %23ccc} button:focus {outline: none}</style>
        <main><h1>Bad</h1><a href="/" tabindex="-1">grey</a><button>no focus</button><input></main></html>"""
    )
    report = wide_and_light(page)
    assert "color-contrast" in "".join(report["axe"])
    faults = ("without a name", "passed over by Tab", "focus not to be seen")
    assert [len(report[each]) for each in faults] == [1, 1, 1]


def test_the_tree_is_asked_for_names_actions_and_levels(page):
    page.set_content(
        """<main tabindex="-1"><h1>One</h1><h3>Three</h3><h2>Two</h2><a href="/"><img></a>
        <form action="/a"><button>Save</button><button>Save</button></form>
        <button>Go</button><form action="/b"><input type="hidden" name="to"><button>Go</button></form></main>"""
    )
    faults = tree_faults(page)
    assert len(faults["focusable without a name"]) == 1
    assert [each.partition(":")[0] for each in faults["buttons of one name"]] == ["Go"]
    assert faults["levels left out"] == ["Three has level 3 after level 1"]
