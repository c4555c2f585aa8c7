"""Labels in doubt, decided by keyboard alone."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from annotations.labelling.audit_findings import store_findings
from annotations.models import AuditFinding
from tests.browser.arriving import wait_for_swap
from tests.doubted_labels import FEMALE, GO, MALE, doubt, say

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

READING = 300  # milliseconds: who decides sooner has not read the label (static/src/typing.js)
SAID = [f"how many girls are in room {number}" for number in range(5)]


@pytest.fixture
def audit_page(page_of, live_server, sample, annotator) -> Page:
    store_findings(sample.world, [doubt(say(sample.world, text)) for text in SAID])
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/audit/")
    expect(row_of(page, SAID[0])).to_be_focused()
    return page


def row_of(page: Page, text: str):
    return page.locator("tr[data-finding]").filter(has_text=text)


def expect_finding(page: Page, text: str) -> None:
    """The label is shown, its row has the focus, and it has been read."""
    expect(page.locator(".audit-text")).to_have_text(text)
    expect(row_of(page, text)).to_be_focused()
    wait_for_swap(page)
    page.wait_for_timeout(READING)


def status_of(text: str) -> str:
    return AuditFinding.objects.get(text=text).status


def test_labels_are_decided_without_a_mouse(audit_page):
    page, keys = audit_page, audit_page.keyboard
    keys.press("j")
    expect_finding(page, SAID[1])
    finding = AuditFinding.objects.get(text=SAID[1])
    expect(page).to_have_url(re.compile(f"finding={finding.pk}$"))
    keys.press("1")
    expect_finding(page, SAID[2])
    assert AuditFinding.objects.get(text=SAID[1]).paraphrase.logical_form == FEMALE
    keys.press("i")
    keys.type("not a command")
    keys.press("Enter")
    keys.press("r")
    expect_finding(page, SAID[3])
    expect(page.get_by_label("Your last decisions")).to_contain_text("excluded: not a command")
    keys.press("z")  # it is in doubt again
    expect_finding(page, SAID[2])
    assert status_of(SAID[2]) == "open"
    keys.press("k")
    expect_finding(page, SAID[0])
    keys.press("a")
    expect_finding(page, SAID[2])
    assert status_of(SAID[0]) == "kept"
    expect(page.locator("#list")).to_contain_text("Wrong labels among the 2")
    keys.press("?")
    expect(page.get_by_role("dialog")).to_contain_text("exclude a label in doubt from new splits")


def test_another_form_is_written(audit_page):
    page, keys = audit_page, audit_page.keyboard
    keys.press("e")
    expect(page.locator(".cm-editor")).to_have_count(1)
    editor = page.get_by_role("textbox", name="Logical form")
    expect(editor).to_be_focused()
    editor.fill(MALE)
    expect(page.locator(".editor-report")).to_contain_text("there is no predicate count")
    keys.press("Control+Enter")  # refused, and what was written stays
    expect(page.get_by_text("This is the label already.")).to_be_visible()
    wait_for_swap(
        page
    )  # the panel came anew: before it has its editor, a plain field would be filled
    expect(page.locator(".cm-editor")).to_have_count(1)
    editor.fill('(go "<room>")')
    keys.press("Control+Enter")
    expect_finding(page, SAID[1])
    assert AuditFinding.objects.get(text=SAID[0]).decided_form == GO
