"""No page scrolls sideways, and no notice lies over what can be pressed, at any width."""

from __future__ import annotations

from datetime import timedelta

import pytest
from django.utils import timezone
from playwright.sync_api import Page, expect

from annotations.models.background import Queue
from gpsr_site.pages.rail import all_entries
from parser_service.models import Worker
from tests.browser.faults import SETTLED
from tests.gpsr_site.routes.addresses import address

WIDTHS = (320, 360, 768, 1280)
STATES = {
    "no worker": [],
    "one that trains nothing": [Queue.QUICK],  # the longest sentence
    "all workers": [Queue.QUICK, Queue.CPU, Queue.GPU],
}

TOO_WIDE = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
# A chart takes its new width some frames late.
FITS = f"""async () => {{
  for (let frames = 0; frames < 600 && {TOO_WIDE} > 0; frames += 1) await new Promise(requestAnimationFrame);
}}"""

# What a notice covers where it lies: two boxes that overlap, in which a click would reach the notice.
COVERED = """() => [...document.querySelectorAll("[data-notice], #connection")].flatMap((notice) =>
  [...document.querySelectorAll("a, button, input, select, textarea")]
    .filter((each) => !notice.contains(each) && each.checkVisibility())
    .filter((each) => {
      const [a, b] = [notice.getBoundingClientRect(), each.getBoundingClientRect()];
      return a.width && b.width && a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    })
    .map((each) => each.outerHTML.slice(0, 80)))"""


def work(queue: str) -> Worker:
    """Make a worker that lives as long as a test."""
    later = timezone.now() + timedelta(hours=1)
    return Worker.objects.create(
        name=queue, host="here", process_id=1, queue=queue, last_seen=later
    )


@pytest.fixture
def quick_worker(transactional_db):
    """A worker that trains nothing."""
    return work(Queue.QUICK)


@pytest.mark.parametrize("state", STATES)
def test_no_page_scrolls_sideways(state, page_of, live_server, sample, admin):
    """The places and tabs of the rail, the banner open and closed; pages/test_every_page.py has all other pages."""
    for queue in STATES[state]:
        work(queue)
    page = page_of(admin, reduced_motion="reduce")  # or the rail is measured on its way out
    faults = []
    for entry in all_entries():
        page.context.clear_cookies(name="closed_notice")
        answer = page.goto(live_server.url + address(entry.page, sample))
        assert answer.status < 400, entry
        banner = page.locator("#banner [data-notice]")
        expect(banner).to_have_count(0 if state == "all workers" else 1)
        page.evaluate(SETTLED)
        faults += [(entry.label, "open", *fault) for fault in faults_of(page)]
        if state != "all workers":
            page.set_viewport_size({"width": WIDTHS[0], "height": 800})
            banner.get_by_role("button", name="Close this notice").click()
            faults += [(entry.label, "closed", *fault) for fault in faults_of(page)]
    assert faults == []


def faults_of(page: Page) -> list[tuple[object, ...]]:
    """Return the widths at which a page is wider than its window or a notice covers a control, with by how much."""
    found = []
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 800})
        page.evaluate(FITS)
        wider, covered = page.evaluate(TOO_WIDE), page.evaluate(COVERED)
        if wider > 0 or covered:
            found.append((width, wider, covered))
    return found


def test_a_missing_worker_is_told_once(page_of, live_server, sample, admin, quick_worker):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/")
    told = page.get_by_text("No training worker").filter(visible=True)
    expect(told).to_have_count(1)
    page.get_by_role("button", name="Close this notice").click()
    expect(page.locator("#worker-state")).to_be_visible()
    expect(told).to_have_count(1)


def test_a_closed_notice_stays_away_until_another_one_comes(
    page_of, live_server, sample, admin, quick_worker
):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/")
    notice = page.locator("#banner [data-notice]")
    notice.get_by_role("button", name="Close this notice").press("Enter")
    expect(notice).to_have_count(0)
    expect(page.locator("#main")).to_be_focused()
    page.goto(f"{live_server.url}/w/home/templates/")
    expect(page.locator("#worker-state")).to_contain_text("No training worker")
    expect(notice).to_have_count(0)
    quick_worker.delete()
    page.reload()
    expect(notice).to_contain_text("No worker is running.")
