"""What somebody with the link of a campaign may try: much, large, forged, again, odd, and scripts."""

from __future__ import annotations

import json
import re
from collections import Counter
from html.parser import HTMLParser

import pytest
from django.core import signing
from django.test import Client

from annotations.campaigns import limits
from annotations.models import (
    AuditEntry,
    Campaign,
    CampaignPrompt,
    Contributor,
    Paraphrase,
    Submission,
    Utterance,
)
from annotations.people.rate_limits import Rate
from annotations.web.campaigns.public_pages import SHOWN
from tests.launched_campaigns import small_campaign

MUCH = 300  # posts; tests.load.campaign sends 10,000 of them to a server
SCRIPT = "<script>alert(1)</script><img src=x onerror=alert(1)>"
PID = "5f3e2d1c0b9a877766554433"


@pytest.fixture
def campaign(world) -> Campaign:
    return small_campaign(world)


@pytest.fixture
def path(campaign) -> str:
    return f"/p/{campaign.key}/"


def begun(path: str, **headers) -> Client:
    client = Client(**headers)
    assert client.post(path, {"agrees": "on"}).status_code == 302
    return client


def rows() -> tuple[int, ...]:
    models = (Contributor, Submission, Paraphrase, Utterance, AuditEntry)
    return tuple(model.objects.count() for model in models)


def texts() -> list[str]:
    return list(Submission.objects.answered().order_by("pk").values_list("text", flat=True))


def test_one_address_begins_few_tasks_however_often_it_posts(path, monkeypatch):
    monkeypatch.setattr(limits, "BEGUN_TASKS", Rate("campaign", limit=10, seconds=3600))
    client = Client()
    statuses: Counter[int] = Counter()
    for _ in range(MUCH):
        client.cookies.clear()
        statuses[client.post(path, {"agrees": "on"}).status_code] += 1
    assert statuses == {302: 10, 429: MUCH - 10}
    assert rows()[:2] == (10, 30)


def test_one_contributor_saves_few_answers_however_often_they_post(
    path, django_assert_max_num_queries
):
    client = begun(path)
    before = rows()
    statuses: Counter[int] = Counter()
    for number in range(MUCH):
        answer = client.post(f"{path}1/", {"text": f"do it {number}", "advised": "on"})
        statuses[answer.status_code] += 1
        if answer.status_code == 429:
            break
    assert statuses == {302: limits.MOST_SAVES, 429: 1}
    with django_assert_max_num_queries(6) as counted:
        client.post(f"{path}1/", {"text": "do it again"})
    assert not [each for each in counted if not each["sql"].startswith("SELECT")]
    assert rows() == before and texts() == [f"do it {limits.MOST_SAVES - 1}"]


@pytest.mark.parametrize("place", ["", "1/", "1/check/", "done/"])
def test_what_is_far_too_large_is_refused_unread(path, place):
    client = begun(path)
    before = rows()
    values = {"text": "x" * 10_000_000, "agrees": "on", "helped": "no"}
    assert client.post(path + place, values).status_code == 413
    assert rows() == before and not texts()


def test_a_place_of_somebody_else_cannot_be_named(campaign, path):
    theirs, mine = begun(path), begun(path)
    them, me = Contributor.objects.order_by("pk")
    foreign = them.submissions.order_by("position").first()
    theirs.post(f"{path}1/", {"text": "what they wrote", "advised": "on"})
    other = CampaignPrompt.objects.exclude(pk=me.submissions.get(position=1).prompt_id).first()
    forged = {
        **{"id": foreign.pk, "pk": foreign.pk, "place": foreign.pk, "position": 2},
        **{"contributor": them.pk, "pseudonym": them.pseudonym, "prompt": other.pk},
        **{"kind": "free", "status": "accepted", "flags": "[]", "seconds": "60", "saves": "0"},
        "shown": signing.dumps([foreign.pk, 0], salt=SHOWN),
    }
    before = me.submissions.get(position=1)
    mine.post(f"{path}1/", {**forged, "text": "what I wrote", "advised": "on"})
    written = me.submissions.get(position=1)
    for name in ("pk", "contributor_id", "prompt_id", "position", "kind", "status"):
        assert getattr(written, name) == getattr(before, name)
    assert written.seconds is None
    assert [each.text for each in (written, them.submissions.get(position=1))] == [
        "what I wrote",
        "what they wrote",
    ]
    for position in (0, 4, 400):  # places that a task of three has not
        assert mine.post(f"{path}{position}/", {"text": "x"}).status_code in (302, 404)
    assert mine.post(f"{path}-1/", {"text": "x"}).status_code == 404
    assert mine.post(f"{path}{10**30}/", {"text": "x"}).status_code == 404
    assert len(texts()) == 2


@pytest.mark.parametrize("at", [0, 10, 23, 25, 30, -1])
def test_an_altered_cookie_is_nobodys(campaign, path, at):
    client = begun(path)
    name = f"campaign_{campaign.pk}"
    value = client.cookies[name].value
    at %= len(value)
    client.cookies[name] = value[:at] + ("0" if value[at] != "0" else "1") + value[at + 1 :]
    assert client.get(f"{path}1/").url == path
    assert client.post(f"{path}1/", {"text": "forged"}).url == path
    assert not texts()


def test_an_id_of_somebody_else_shows_and_changes_nothing_that_they_wrote(path):
    theirs = Client()
    theirs.get(f"{path}?PROLIFIC_PID={PID}")
    theirs.post(path, {"agrees": "on"})
    theirs.post(f"{path}1/", {"text": "what they wrote", "advised": "on"})
    before = rows()
    for name in ("PROLIFIC_PID", "workerId"):
        query = f"?{name}={PID}"
        forger = Client()
        for place in ("", "1/", "done/"):
            for answer in (
                forger.get(path + place + query),
                forger.get(path + place),
                forger.post(path + place + query, {"text": "forged", "helped": "no"}),
                forger.post(f"{path}1/check/{query}", {"text": "forged"}),
            ):
                assert "what they wrote" not in answer.content.decode()
        assert rows() == before and texts() == ["what they wrote"]


def test_posts_that_come_again_after_the_end_change_nothing(path):
    client = begun(path)
    page = client.get(f"{path}1/").content.decode()
    sent = dict(re.findall(r'<input type="hidden" name="(\w+)" value="([^"]*)"', page))
    for place in (1, 2, 3):
        client.post(f"{path}{place}/", {**sent, "text": f"do it {place}", "advised": "on"})
    for _ in range(2):
        client.post(f"{path}done/", {"helped": "no"})
    finished = Contributor.objects.values().get()
    before = list(Submission.objects.values())
    for text in ("do it 1", "another text"):
        assert client.post(f"{path}1/", {**sent, "text": text}).url == f"{path}done/"
    assert client.post(f"{path}done/", {"helped": "yes"}).status_code == 200
    assert client.post(path, {"agrees": "on"}).url == f"{path}done/"
    assert Contributor.objects.values().get() == finished
    assert list(Submission.objects.values()) == before


@pytest.mark.parametrize(
    ("sent", "stored"),
    [
        (b"do+it%00+now", None),
        (b"%00", None),
        (b"%E2%80%8B%E2%80%8D%EF%BB%BF%C2%AD", None),  # characters that nobody sees
        (b"do%E2%80%8B+it", "do it"),
        (b"do+%ED%A0%80+it", "do \ufffd\ufffd\ufffd it"),  # half of a pair, which UTF-8 has not
        (b"do+%FF+it", "do \ufffd it"),
        (b"%E2%80%AEdo+it", "do it"),  # written from right to left
        (b"do%0D%0A%0D%0Ait%09now", "do it now"),
        (b"%F0%9F%92%A9+" * 10, "\U0001f4a9 " * 9 + "\U0001f4a9"),
        (b"x" * 500, "x" * 500),
    ],
)
def test_odd_characters_are_made_plain_or_refused(path, sent, stored):
    client = begun(path)
    kind = "application/x-www-form-urlencoded"
    answer = client.post(f"{path}1/", b"advised=on&text=" + sent, content_type=kind)
    assert answer.status_code == (422 if stored is None else 302)
    found = texts()
    assert client.get(f"{path}1/").status_code == 200
    if stored is None:
        assert not found
    else:
        assert [normal(each) for each in found] == [normal(stored)]
    checked = client.post(f"{path}1/check/", b"text=" + sent, content_type=kind)
    assert checked.status_code == 200 and "warnings" in checked.json()


def normal(text: str) -> str:
    """A text without what is not seen, however much of it was taken out."""
    return re.sub(r"[\u200b\u202e\s]+", " ", text).strip()


def test_scripts_in_every_field_are_shown_and_not_run(adam, rene, anna, world, call_as, admin):
    texts_of_campaign = ("introduction", "examples", "consent", "thanks", "completion_code")
    campaign = small_campaign(
        world,
        name=SCRIPT,
        currency=SCRIPT[:8],
        price=1,
        taboo_words=3,
        return_url="https://x.example/?a=%22%3E%3Cscript%3E&b='onclick='alert(1)",
        **{
            name: SCRIPT[:40] if name == "completion_code" else SCRIPT for name in texts_of_campaign
        },
    )
    entities = [{"text": SCRIPT, "aliases": [SCRIPT], "is_described": False}]
    campaign.prompts.update(shown=f"find {SCRIPT}", prompt=f"find {SCRIPT}", entities=entities)
    public = f"/p/{campaign.key}/"
    client = Client()
    shown = [client.get(public), client.post(public, {"agrees": SCRIPT}, follow=True)]
    for place in (1, 2, 3):
        odd = {"text": f"{SCRIPT} {place}", "shown": SCRIPT, "pasted": SCRIPT, "advised": ""}
        shown.append(client.post(f"{public}{place}/", odd, follow=True))
        shown.append(client.get(f"{public}{place}/?advice=1"))
        advice = client.post(f"{public}{place}/check/", {"text": SCRIPT})
        assert advice["Content-Type"] == "application/json"
        assert advice["X-Content-Type-Options"] == "nosniff"
    shown.append(client.post(f"{public}1/", {"text": SCRIPT * 20, "shown": SCRIPT}))
    shown.append(client.post(f"{public}done/", {"helped": SCRIPT}))
    shown += [client.post(f"{public}done/", {"helped": "no"}, follow=True), client.get(public)]
    contributor = Contributor.objects.get()
    rewrite, _, free = contributor.submissions.order_by("position")
    below = f"/w/home/campaigns/{campaign.pk}/"
    shown += [
        adam.get(page)
        for page in (
            *("/w/home/campaigns/", below, f"{below}state/", f"{below}edit/", f"{below}model/"),
            f"/w/home/contributors/{contributor.pk}/forget/",
        )
    ]
    shown.append(adam.post(f"{below}edit/", {"thanks": SCRIPT, "return_url": SCRIPT}))
    listed = "/w/home/submissions/"
    shown += [rene.get(listed), rene.get(f"{listed}?q=%3Cscript%3E&campaign={campaign.pk}")]
    shown += [rene.get(f"{listed}{row.pk}/") for row in (rewrite, free)]
    for row in (rewrite, free):
        post = {"decision": "accept"}
        shown.append(rene.post(f"{listed}{row.pk}/decide/", post, follow=True))
    paraphrase, utterance = Paraphrase.objects.get(), Utterance.objects.get()
    assert "<script>" in paraphrase.utterance and "<script>" in utterance.text
    shown += [
        anna.get(page)
        for page in (
            *("/w/home/paraphrases/", f"/w/home/paraphrases/{paraphrase.pk}/"),
            *("/w/home/utterances/", f"/w/home/utterances/{utterance.pk}/", "/w/home/label/"),
        )
    ]
    shown.append(adam.get("/w/home/log/"))
    for answer in shown:
        assert answer.status_code in (200, 422), answer.request["PATH_INFO"]
        assert not what_runs_in(answer.content.decode()), answer.request["PATH_INFO"]
    inert = sum("&lt;script&gt;" in answer.content.decode() for answer in shown)
    assert inert > 20
    for route in ("campaigns", "contributors", "submissions", "paraphrases", "utterances"):
        answer = call_as(admin, "get", f"worlds/home/{route}/")
        assert answer["Content-Type"] == "application/json"
        assert answer["X-Content-Type-Options"] == "nosniff"
        json.loads(answer.content)
    for name, kind in (("utterances/export/?as=csv", "text/csv"), ("download/", "application/zip")):
        answer = call_as(admin, "get", f"worlds/home/{name}")
        assert answer["Content-Type"].startswith(kind)
        assert answer["Content-Disposition"].startswith("attachment")


def what_runs_in(page: str) -> list[str]:
    """Return what a browser would run of ``page`` that is no file of the site."""
    running: list[str] = []

    class Reader(HTMLParser):
        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            given = {name: value or "" for name, value in attrs}
            running.extend(name for name in given if name.startswith("on"))
            is_ours = given.get("src", "").startswith("/static/") or "type" in given
            if (tag == "script" and not is_ours) or tag in ("img", "iframe", "object", "embed"):
                running.append(tag)
            for name in ("href", "src", "action", "formaction"):
                if given.get(name, "").strip().lower().startswith(("javascript:", "data:text")):
                    running.append(given[name])

    Reader().feed(page)
    return running


def test_the_reader_of_pages_finds_what_runs():
    for page in (SCRIPT, "<p onclick=x>", "<a href=' JavaScript:x'>", "<script>x</script>"):
        assert what_runs_in(page)
    assert not what_runs_in("&lt;script&gt; <a href='/x'>onclick=</a>")
