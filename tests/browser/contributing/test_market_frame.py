"""A campaign in the frame of a crowd market on another site, where browsers keep no cookies of it."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from functools import partial
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest
from playwright.sync_api import expect

from annotations.models import Campaign, Contributor, Submission
from tests.launched_campaigns import small_campaign

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

IDS = "workerId=worker-1&assignmentId=A1&hitId=H1"


class Market(BaseHTTPRequestHandler):
    """Shows a page in a frame, and keeps what is posted to it."""

    def __init__(self, page: list[str], posted: list[str], *args: object) -> None:
        self._page, self._posted = page, posted
        super().__init__(*args)

    def do_GET(self) -> None:
        self._answer(f'<iframe src="{self._page[0]}" width="800" height="900"></iframe>')

    def do_POST(self) -> None:
        length = int(self.headers["Content-Length"])
        self._posted.append(self.rfile.read(length).decode())
        self._answer("Handed in.")

    def log_message(self, *args: object) -> None:
        pass

    def _answer(self, body: str) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(body.encode())


@pytest.fixture
def market() -> Iterator[tuple[str, list[str], list[str]]]:
    """Return the address of a market, the page that it frames, and what was posted to it."""
    page: list[str] = []
    posted: list[str] = []
    server = HTTPServer(("127.0.0.1", 0), partial(Market, page, posted))
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}", page, posted
    server.shutdown()
    thread.join()


def test_from_the_frame_to_what_the_market_wants(market, world, live_server, page_without_login):
    address, framed, posted = market
    campaign = small_campaign(
        world, completion_code="C0FFEE", frame_origins=address, return_url=f"{address}/submit"
    )
    framed.append(f"{live_server.url}/p/{campaign.key}/?{IDS}")
    page = page_without_login
    page.goto(address)
    frame = page.frame_locator("iframe")
    frame.get_by_label("I agree").check()
    frame.get_by_role("button", name="Begin").click()
    for number in range(1, 4):
        expect(frame.locator(".campaign-bar span")).to_contain_text(f"{number} of 3")
        frame.locator("#text").fill(f"do number {number} of these things for me please")
        frame.locator("#text").press("Enter")
        keep = frame.get_by_role("button", name="Keep it, go on")
        done = frame.locator(f".campaign-bar span:text('{number + 1} of 3'), #helped-no")
        expect(keep.or_(done).first).to_be_visible()
        if keep.is_visible():
            keep.click()
    frame.get_by_label("No, I wrote all of it myself").check()
    frame.get_by_role("button", name="Finish").click()
    expect(frame.locator("#code")).to_have_value("C0FFEE")
    frame.get_by_role("button", name="Hand in").click()
    expect(frame.get_by_text("Handed in.")).to_be_visible()
    (sent,) = posted
    assert "assignmentId=A1" in sent and "code=C0FFEE" in sent
    assert Contributor.objects.get().is_finished and Submission.objects.answered().count() == 3


def test_another_site_frames_nothing(market, world, live_server, page_without_login):
    address, framed, _ = market
    campaign = small_campaign(world, frame_origins="https://market.example")
    framed.append(f"{live_server.url}/p/{campaign.key}/?{IDS}")
    page_without_login.goto(address)
    expect(page_without_login.frame_locator("iframe").get_by_label("I agree")).to_have_count(0)
    assert Campaign.objects.get().contributors.count() == 0
