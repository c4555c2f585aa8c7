"""Whoever comes from a crowd market gets on: in another browser, in a frame, by a link that nobody has filled in."""

from __future__ import annotations

import re
from urllib.parse import quote

import pytest
from django.test import Client

from annotations.models import Campaign, Contributor, Submission
from tests.launched_campaigns import small_campaign

CODE, OTHER_CODE = "C0FFEE", "N0TE4"
MARKET = "https://worker.market.example"


@pytest.fixture
def campaign(world) -> Campaign:
    return small_campaign(
        world, completion_code=CODE, screened_out_code=OTHER_CODE, return_url=f"{MARKET}/back"
    )


@pytest.fixture
def path(campaign) -> str:
    return f"/p/{campaign.key}/"


def change(campaign: Campaign, **values: object) -> None:
    Campaign.objects.filter(pk=campaign.pk).update(**values)


def come(path: str, query: str, client: Client | None = None, **headers: str) -> tuple[Client, str]:
    """Open a link in a browser; return it with the address at which it comes to rest."""
    client = client or Client(enforce_csrf_checks=True)
    answer = client.get(f"{path}?{query}", headers=headers)
    address = f"{path}?{query}"
    while answer.status_code == 302:
        address = answer.url
        answer = client.get(address, headers=headers)
    assert answer.status_code == 200
    return client, address


def send(client: Client, address: str, **fields: str):
    """Send the form at an address, with its hidden fields, to where it stands or leads."""
    page = client.get(address).content.decode()
    hidden = dict(re.findall(r'<input type="hidden" name="(\w+)" value="([^"]*)"', page))
    action = re.search(r'action="(/p/[^"]*)"', page)
    return client.post(action[1] if action else address, {**hidden, "advised": "on", **fields})


def write_all(client: Client, address: str, word: str = "do") -> str:
    """Begin or go on, write at each place, finish; return the last page."""
    answer = send(client, address, agrees="on", fits="yes")
    number = 0
    while "/done/" not in answer.url:
        number += 1
        answer = send(client, answer.url, text=f"{word} number {number}")
        assert answer.status_code == 302 and number < 9
    ended = answer.url
    answer = send(client, ended, helped="no")
    return client.get(answer.url if answer.status_code == 302 else ended).content.decode()


def test_the_same_id_in_another_browser_goes_on_and_comes_to_the_code(path):
    first, address = come(path, "PROLIFIC_PID=p3")
    begun = send(first, address, agrees="on")
    send(first, begun.url, text="what I wrote at first")
    second, address = come(path, "PROLIFIC_PID=p3")
    # What was written elsewhere is neither shown nor changed: its place leads to the next empty one.
    assert second.get(f"{path}1/").url == f"{path}2/"
    page = second.get(f"{path}2/").content.decode()
    assert "what I wrote" not in page
    assert f'href="{path}"' in page  # back leads to what may be seen
    assert send(second, f"{path}2/", text="else").status_code == 302
    assert second.post(f"{path}1/", {"text": "overwritten"}).status_code == 403  # without a token
    assert CODE in write_all(second, address)
    assert Contributor.objects.get().is_finished
    assert Submission.objects.get(position=1).text == "what I wrote at first"
    # A third one, after the end, comes to the code too.
    third, address = come(path, "PROLIFIC_PID=p3")
    assert CODE in third.get(f"{path}done/").content.decode()


def test_another_id_in_one_browser_is_another_person(path):
    browser, address = come(path, "PROLIFIC_PID=p3")
    assert CODE in write_all(browser, address)
    come(path, "PROLIFIC_PID=p5", browser)
    assert browser.get(f"{path}done/").url == path
    assert "agrees" in browser.get(path).content.decode()
    assert CODE in write_all(browser, path, "say")
    assert Contributor.objects.count() == 2
    # Who comes back sees what they wrote here.
    come(path, "PROLIFIC_PID=p3", browser)
    assert CODE in browser.get(f"{path}done/").content.decode()


@pytest.mark.parametrize(
    "value",
    [
        *("{{%PROLIFIC_PID%}}", "${workerId}", "%ID%", "[ID]", "<your id>", "{id}", "[%pid%]"),
        *("%7B%7B%25PROLIFIC_PID%25%7D%7D", "__ID__", "##ID##", "$WORKER", "[[ID]]", "((id))"),
        *("null", "undefined", "PROLIFIC_PID", "prolific_pid", "@@worker id@@", "{% id %}"),
    ],
)
def test_what_nobody_filled_in_is_no_person(path, value):
    for sent in (value, quote(value, safe="")):
        for _ in range(2):
            browser, address = come(path, f"PROLIFIC_PID={sent}")
            assert address == path
            assert send(browser, address, agrees="on").url == f"{path}1/"
    assert Contributor.objects.count() == 4


@pytest.mark.parametrize(
    "value", ["5f3e2d1c0b9a877766554433", "A1B2", "auth0|12", "a@b.example", "dGVzdA==", "x" * 1000]
)
def test_an_id_is_a_person_however_long_and_leaves_the_address(path, value):
    for _ in range(2):
        browser, address = come(path, f"PROLIFIC_PID={quote(value)}&STUDY_ID=1&SESSION_ID=2")
        assert address == path
        send(browser, address, agrees="on")
    (contributor,) = Contributor.objects.all()
    longer, address = come(path, f"PROLIFIC_PID={quote(value)}0")
    send(longer, address, agrees="on")
    assert Contributor.objects.exclude(pseudonym=contributor.pseudonym).count() == 1


def test_a_market_calls_its_parameters_as_it_likes(campaign, path):
    change(
        campaign,
        worker_parameter="rid",
        assignment_parameter="session",
        return_url=f"{MARKET}/end?s={{assignment}}",
    )
    for _ in range(2):
        browser, address = come(path, "rid=w7&session=a%2F1&PROLIFIC_PID=not-asked")
        send(browser, address, agrees="on")
    assert Contributor.objects.count() == 1
    page = write_all(browser, address)
    assert f'href="{MARKET}/end?s=a%2F1"' in page


def test_no_page_is_framed_unless_the_campaign_names_the_market(path):
    answer = Client().get(path)
    assert answer["X-Frame-Options"] == "DENY"
    assert "frame-ancestors 'none'" in answer["Content-Security-Policy"]


def test_in_a_frame_nobody_needs_a_cookie(campaign, path):
    change(campaign, frame_origins=MARKET, return_url=f"{MARKET}/submit")
    for sort in ({}, {"sec_fetch_dest": "iframe"}):
        frame, address = come(path, "workerId=worker-1&assignmentId=A1&hitId=H1", **sort)
        assert "visit=" in address and "worker-1" not in address
        assert f"campaign_{campaign.pk}" not in frame.cookies
        answer = frame.get(address)
        assert "X-Frame-Options" not in answer
        assert f"frame-ancestors {MARKET};" in answer["Content-Security-Policy"] + ";"
    frame.cookies.clear()
    begun = send(frame, address, agrees="on")
    assert begun.status_code == 302 and "visit=" in begun.url
    frame.cookies.clear()
    page = write_all(frame, address)
    # The market wants to be told by a form of the frame.
    assert f'action="{MARKET}/submit"' in page
    assert 'name="assignmentId" value="A1"' in page and CODE in page
    assert Contributor.objects.get().is_finished


def test_a_campaign_that_may_be_framed_knows_browsers_by_cookies_outside_of_frames(campaign, path):
    change(campaign, frame_origins=MARKET)
    browser, address = come(path, "workerId=W1", sec_fetch_dest="document")
    assert address == path and browser.cookies
    assert (
        Client(enforce_csrf_checks=True)
        .post(path, {"agrees": "on"}, headers={"sec-fetch-dest": "document"})
        .status_code
        == 403
    )


def test_words_that_nobody_signed_are_nobodys(campaign, path, world):
    change(campaign, frame_origins=MARKET)
    frame, address = come(path, "workerId=W1")
    begun = send(frame, address, agrees="on").url
    other = small_campaign(world, name="other", frame_origins=MARKET)
    elsewhere = begun.replace(campaign.key, other.key)
    for forged in (begun[:-1] + ("a" if begun[-1] != "a" else "b"), elsewhere, f"{path}1/?visit=x"):
        assert Client().get(forged).status_code == 302
    assert Client().get(begun).status_code == 200


@pytest.mark.parametrize("query", ["visit=preview", "assignmentId=ASSIGNMENT_ID_NOT_AVAILABLE"])
def test_a_preview_shows_the_task_and_stores_nothing(campaign, path, query):
    change(campaign, frame_origins=MARKET, screening_question="Do you speak English?")
    browser, address = come(path, query)
    answer = send(browser, address, agrees="on", fits="yes")
    shown = ""
    for number in range(1, 4):
        shown += browser.get(answer.url).content.decode()
        answer = send(browser, answer.url, text=f"do {number}")
    ended = browser.post(answer.url, {"helped": "no"}).content.decode()
    assert all(each.shown in shown for each in campaign.prompts.all())
    assert "Thank you" in ended and CODE not in ended
    assert not Contributor.objects.exists() and not Submission.objects.exists()


def test_who_does_not_fit_gets_a_code_of_their_own_and_no_task(campaign, path):
    change(campaign, screening_question="Do you speak English?", screened_out_url=f"{MARKET}/out")
    browser, address = come(path, "PROLIFIC_PID=p3")
    assert send(browser, address, agrees="on").status_code == 422
    page = send(browser, address, fits="no").content.decode()
    assert OTHER_CODE in page and CODE not in page and f"{MARKET}/out" in page
    assert OTHER_CODE in browser.get(path).content.decode()
    assert not Contributor.objects.exists()
    # Somebody else may fit.
    other, address = come(path, "PROLIFIC_PID=p5", browser)
    assert CODE in write_all(other, address)


def test_the_consent_says_how_much_how_long_what_for_and_by_whom(campaign, path):
    change(
        campaign,
        price="1.50",
        currency="EUR",
        run_by="Lab of Robots",
        contact="ethics@lab.example",
        minutes=7,
    )
    page = Client().get(path).content.decode()
    for said in ("2 commands", "1 command", "7 minutes", "1.50 EUR", "Lab of Robots"):
        assert said in page
    assert 'href="mailto:ethics@lab.example"' in page
    client = Client()
    sent = dict(re.findall(r'<input type="hidden" name="(\w+)" value="([^"]*)"', page))
    change(campaign, price="0.50")  # another pay is another consent
    assert client.post(path, {**sent, "agrees": "on"}).status_code == 422
