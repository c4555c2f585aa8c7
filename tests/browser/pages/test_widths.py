"""No page scrolls sideways, and no notice lies over what can be pressed, at any width."""

from __future__ import annotations

from datetime import timedelta

import pytest
from django.utils import timezone
from playwright.sync_api import expect

from annotations.models.background import Queue
from parser_service.models import Worker
from tests.browser.faults import SETTLED

WIDTHS = (360, 390, 640, 768, 1280)
PAGES = (
    *("", "ontology/", "ontology/new/", "grammar/", "templates/", "templates/new/", "commands/"),
    *("paraphrases/", "utterances/", "utterances/new/", "queue/", "queue/settings/", "label/"),
    *("splits/", "runs/", "runs/new/", "results/", "review/", "parse/", "promotion/", "people/"),
    *("import/", "jobs/"),
)

TOO_WIDE = "document.documentElement.scrollWidth - document.documentElement.clientWidth"

# What a notice covers where it lies: two boxes that overlap, in which a click would reach the notice.
COVERED = """() => [...document.querySelectorAll("[data-notice], #connection")].flatMap((notice) =>
  [...document.querySelectorAll("a, button, input, select, textarea")]
    .filter((each) => !notice.contains(each) && each.checkVisibility())
    .filter((each) => {
      const [a, b] = [notice.getBoundingClientRect(), each.getBoundingClientRect()];
      return a.width && b.width && a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    })
    .map((each) => each.outerHTML.slice(0, 80)))"""


@pytest.fixture
def quick_worker(transactional_db):
    """A worker that trains nothing, so that the longest state stands in the top bar."""
    later = timezone.now() + timedelta(hours=1)
    return Worker.objects.create(
        name="quick", host="here", process_id=1, queue=Queue.QUICK, last_seen=later
    )


def test_no_page_scrolls_sideways(page_of, live_server, sample, admin, quick_worker):
    page = page_of(admin)
    faults = []
    for path in PAGES:
        answer = page.goto(f"{live_server.url}/w/home/{path}")
        assert answer.status < 400, path
        expect(page.locator("#banner")).to_contain_text("No training worker is running.")
        page.evaluate(SETTLED)
        for width in WIDTHS:
            page.set_viewport_size({"width": width, "height": 800})
            wider, covered = page.evaluate(TOO_WIDE), page.evaluate(COVERED)
            if wider > 0 or covered:
                faults.append((path, width, wider, covered))
    assert faults == []


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
