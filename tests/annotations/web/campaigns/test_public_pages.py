"""The pages behind the link of a campaign: who contributes, what is saved, and what is refused."""

from __future__ import annotations

import re
from datetime import timedelta

import pytest
from django.db import connection
from django.test import Client
from django.utils import timezone

from annotations.campaigns import limits
from annotations.campaigns.closing import revoke_link
from annotations.models import AuditEntry, Contributor, Submission
from annotations.models.campaigns import GRACE
from annotations.people.rate_limits import Rate
from annotations.web.campaigns import public_pages

PID = "5f3e2d1c0b9a877766554433"
SCRIPT = "<script>alert(1)</script>"


@pytest.fixture
def campaign(launched):
    return launched(
        task_size=2,
        free_commands=1,
        completion_code="C0FFEE",
        return_url="https://market.example/back",
    )


@pytest.fixture
def address(campaign):
    return f"/p/{campaign.key}/"


def begun(campaign, query: str = "") -> Client:
    """Return a browser in which somebody has begun the task."""
    client = Client()
    answer = client.post(f"/p/{campaign.key}/{query}", {"agrees": "on"})
    assert answer.status_code == 302
    return client


def fields(client: Client, path: str) -> dict[str, str]:
    """Return the hidden fields of the form at ``path``."""
    page = client.get(path).content.decode()
    return dict(re.findall(r'<input type="hidden" name="(\w+)" value="([^"]*)"', page))


def text_of(answer) -> str:
    return answer.content.decode()


def test_the_whole_way(client, campaign, address):
    assert "I agree" in text_of(client.get(address))
    refused = client.post(address)
    assert refused.status_code == 422
    assert not Contributor.objects.exists()
    assert client.post(address, {"agrees": "on"}).url == f"{address}1/"
    (contributor,) = Contributor.objects.all()
    assert contributor.consented_at
    first = contributor.submissions.get(position=1)
    page = text_of(client.get(f"{address}1/"))
    assert first.prompt.shown in page and "1 of 3" in page
    assert client.get(f"{address}done/").url == f"{address}1/"
    # A copy is saved, and then there is advice, once.
    advised = client.post(f"{address}1/", {"text": first.prompt.shown})
    assert advised.url == f"{address}1/?advice=1"
    page = text_of(client.get(advised.url))
    assert public_pages.WARNINGS["too_close"] in page and "Keep it" in page
    kept = client.post(f"{address}1/", {"text": first.prompt.shown, "advised": "on"})
    assert kept.url == f"{address}2/"
    # Who comes back goes on where something is empty.
    assert "Welcome back" in text_of(client.get(address))
    assert client.post(address).url == f"{address}2/"
    client.post(f"{address}2/", {"text": "do that other thing", "advised": "on"})
    assert client.post(f"{address}3/", {"text": "water the plants"}).url == f"{address}done/"
    assert text_of(client.get(f"{address}1/")).count(first.prompt.shown) == 2
    assert "language model" in text_of(client.get(f"{address}done/"))
    assert client.post(f"{address}done/").status_code == 422
    assert client.post(f"{address}done/", {"helped": "no"}).url == f"{address}done/"
    page = text_of(client.get(f"{address}done/"))
    assert "C0FFEE" in page and "https://market.example/back" in page
    contributor.refresh_from_db()
    assert contributor.is_finished and contributor.had_model_help is False
    assert "You have finished" in text_of(client.get(address))
    assert client.get(f"{address}2/").url == f"{address}done/"
    assert client.post(f"{address}2/", {"text": "x"}).url == f"{address}done/"


def test_nothing_of_a_page_is_kept_by_others(client, address):
    answer = client.get(address)
    assert "no-store" in answer["Cache-Control"]
    (cookie,) = [each for name, each in client.cookies.items() if name.startswith("campaign_")]
    assert cookie["httponly"] and cookie["samesite"] == "Lax" and cookie["path"] == "/p/"


def test_a_task_that_nobody_has_begun_leads_to_its_first_page(client, address):
    for path in ("1/", "99/", "done/"):
        assert client.get(address + path).url == address
        assert client.post(address + path, {"text": "go"}).url == address
    assert client.get(f"{address}4000/").status_code == 404
    assert not Submission.objects.exists()


def test_a_forged_cookie_is_nobodys(campaign, address):
    begun(campaign)
    (theirs,) = Contributor.objects.all()
    forger = Client()
    for value in (theirs.pseudonym, f"{theirs.pseudonym}:1:x", ""):
        forger.cookies[f"campaign_{campaign.pk}"] = value
        assert forger.get(f"{address}1/").url == address
        assert forger.post(f"{address}1/", {"text": "forged"}).url == address
    assert not Submission.objects.answered().exists()


def test_a_cookie_of_another_campaign_is_nobodys(campaign, address, launched):
    other = begun(launched(name="other"))
    (name,) = [each for each in other.cookies if each.startswith("campaign_")]
    other.cookies[f"campaign_{campaign.pk}"] = other.cookies[name].value
    assert other.get(f"{address}1/").url == address


@pytest.mark.parametrize("name", ["PROLIFIC_PID", "workerId"])
def test_the_id_of_a_crowd_market_becomes_a_pseudonym(campaign, address, name, client):
    led = client.get(f"{address}?{name}={PID}&STUDY_ID=1")
    assert led.url == address
    assert client.post(address, {"agrees": "on"}).url == f"{address}1/"
    (contributor,) = Contributor.objects.all()
    assert PID not in contributor.pseudonym


def test_an_id_is_stored_nowhere(campaign, address, client):
    client.get(f"{address}?PROLIFIC_PID={PID}")
    client.post(address, {"agrees": "on"})
    client.post(f"{address}1/?PROLIFIC_PID={PID}", {"text": "do it"})
    with connection.cursor() as cursor:
        for table in connection.introspection.table_names():
            cursor.execute(f'SELECT * FROM "{table}"')
            assert not [row for row in cursor.fetchall() if PID in str(row)], table
    assert PID not in str(client.cookies)


@pytest.mark.parametrize("value", ["", "%00", "%0d%0aSet-Cookie:%20a=b", "x" * 3000, "%ff", "💩"])
def test_an_id_that_cannot_be_is_none(value, address, client):
    assert client.get(f"{address}?PROLIFIC_PID={value}").status_code in (200, 302)
    assert client.post(f"{address}?PROLIFIC_PID={value}", {"agrees": "on"}).status_code == 302
    assert Contributor.objects.get().pseudonym.isalnum()


def test_who_has_finished_begins_again_only_where_that_is_allowed(launched):
    campaign = launched(task_size=1, free_commands=0)
    client = begun(campaign)
    address = f"/p/{campaign.key}/"
    client.post(f"{address}1/", {"text": "do it", "advised": "on"})
    client.post(f"{address}done/", {"helped": "yes"})
    assert client.post(address, {"agrees": "on"}).url == f"{address}done/"
    campaign.allows_retake = True
    campaign.save()
    assert "I agree" in text_of(client.get(address))
    assert client.post(address, {"agrees": "on"}).url == f"{address}1/"
    assert Contributor.objects.count() == 2


def test_a_link_that_is_unknown_or_revoked_says_so(client, campaign, address):
    assert client.get("/p/nothing/").status_code == 404
    assert client.get("/p/a%00b/").status_code == 404
    campaign.key = ""
    campaign.save()
    for path in ("", "1/", "done/"):
        answer = client.get(address + path)
        assert answer.status_code == 404 and "No campaign has this link" in text_of(answer)


@pytest.mark.parametrize(
    "values",
    [
        {"closed_at": timezone.now()},
        {"ends_at": timezone.now() - timedelta(seconds=1)},
        {"most_submissions": 0},
    ],
)
def test_a_campaign_that_is_over_is_not_begun(values, client, campaign, address):
    type(campaign).objects.filter(pk=campaign.pk).update(**values)
    for answer in (client.get(address), client.post(address, {"agrees": "on"})):
        assert answer.status_code == 410 and "is over" in text_of(answer)
    assert not Contributor.objects.exists()


def test_who_has_begun_finishes_after_the_end_and_is_told_until_when(campaign, address):
    client, finished = begun(campaign), begun(campaign)
    Contributor.objects.filter(pk=Contributor.objects.last().pk).update(finished_at=timezone.now())
    type(campaign).objects.update(closed_at=timezone.now(), allows_retake=True)
    for path in (address, f"{address}1/"):
        assert "You may finish until" in text_of(client.get(path))
    assert client.post(f"{address}1/", {"text": "do it"}).status_code == 302
    # Who has finished still sees that, and begins no other task.
    assert "You have finished" in text_of(finished.get(address))
    assert finished.post(address, {"agrees": "on"}).status_code == 302
    assert Contributor.objects.count() == 2


def test_what_is_written_after_the_grace_is_refused(campaign, address):
    client = begun(campaign)
    type(campaign).objects.update(closed_at=timezone.now() - GRACE)
    for path in (address, f"{address}1/"):
        answer = client.get(path)
        assert answer.status_code == 410 and "What you wrote is kept" in text_of(answer)
    assert client.post(f"{address}1/", {"text": "do it"}).status_code == 410
    assert not Submission.objects.answered().exists()


def test_a_revoked_link_stops_everybody_at_once(campaign, address):
    client = begun(campaign)
    revoke_link(campaign)
    assert client.get(f"{address}1/").status_code == 404
    assert client.post(f"{address}1/", {"text": "do it"}).status_code == 404
    assert not Submission.objects.answered().exists()


def test_who_read_another_consent_reads_it_again(campaign, address, client):
    sent = {**fields(client, address), "agrees": "on"}
    type(campaign).objects.update(consent="Another text.")
    refused = client.post(address, sent)
    assert refused.status_code == 422 and "Another text." in text_of(refused)
    assert not Contributor.objects.exists()
    sent = {**fields(client, address), "agrees": "on"}
    assert client.post(address, sent).status_code == 302


def test_who_has_begun_finishes_though_the_campaign_is_full(campaign, address):
    first, second = begun(campaign), begun(campaign)
    type(campaign).objects.update(most_submissions=1)
    for client in (first, second):
        assert client.post(f"{address}1/", {"text": "do it"}).status_code == 302
    assert Submission.objects.answered().count() == 2


def test_answers_come_too_often(campaign, address, monkeypatch):
    monkeypatch.setattr(limits, "MOST_SAVES", 2)
    client = begun(campaign)
    statuses = [client.post(f"{address}1/", {"text": f"do {n}"}).status_code for n in range(4)]
    assert statuses == [302, 302, 429, 429]
    refused = client.post(f"{address}1/", {"text": "what I typed"})
    assert "what I typed" in text_of(refused)
    assert 50 <= int(refused["Retry-After"]) <= 60
    assert Submission.objects.answered().get().text == "do 1"
    Contributor.objects.update(saves_since=timezone.now() - timedelta(minutes=1))
    assert client.post(f"{address}1/", {"text": "do 5"}).status_code == 302
    assert Contributor.objects.get().saves == 1


def test_one_address_begins_no_thousands_of_tasks(campaign, monkeypatch):
    monkeypatch.setattr(limits, "BEGUN_TASKS", Rate("campaign", limit=3, seconds=60))
    path = f"/p/{campaign.key}/"
    answers = [Client().post(path, {"agrees": "on"}) for _ in range(20)]
    assert [answer.status_code for answer in answers] == [302] * 3 + [429] * 17
    assert Contributor.objects.count() == 3
    elsewhere = Client(REMOTE_ADDR="192.0.2.1")
    assert elsewhere.post(path, {"agrees": "on"}).status_code == 302


def test_a_link_begins_no_thousands_of_tasks_wherever_they_come_from(launched):
    campaign = launched(most_per_hour=3)
    path = f"/p/{campaign.key}/"
    answers = [
        Client(REMOTE_ADDR=f"192.0.2.{number}").post(path, {"agrees": "on"}) for number in range(6)
    ]
    assert [answer.status_code for answer in answers] == [302] * 3 + [429] * 3
    assert 3590 <= int(answers[-1]["Retry-After"]) <= 3600
    # Those who have begun go on, and the next ones come when the first of the three is an hour old.
    Contributor.objects.filter(pk=Contributor.objects.first().pk).update(
        began_at=timezone.now() - timedelta(hours=1)
    )
    assert Client().post(path, {"agrees": "on"}).status_code == 302
    assert Client().post(path, {"agrees": "on"}).status_code == 429


@pytest.mark.parametrize(("size", "status"), [(501, 422), (10_000_000, 413)])
def test_too_long_an_answer_is_refused(campaign, address, size, status):
    client = begun(campaign)
    assert client.post(f"{address}1/", {"text": "x" * size}).status_code == status
    assert not Submission.objects.answered().exists()


@pytest.mark.parametrize("text", ["", "  ", "\u200b", "a\0b"])
def test_no_text_is_refused(campaign, address, text):
    client = begun(campaign)
    assert client.post(f"{address}1/", {"text": text}).status_code == 422


def test_a_post_that_comes_again_changes_nothing(campaign, address):
    client = begun(campaign)
    sent = {**fields(client, f"{address}1/"), "text": "do it"}
    for _ in range(3):
        client.post(f"{address}1/", sent)
    client.post(
        f"{address}2/", sent
    )  # and what was signed for one place says nothing about another
    first, second = Submission.objects.answered().order_by("position")
    assert first.seconds is not None and second.seconds is None
    assert Submission.objects.count() == 3


@pytest.mark.parametrize("shown", ["", "1:2:3", "9" * 200, "💩"])
def test_a_forged_time_counts_as_none(campaign, address, shown):
    client = begun(campaign)
    client.post(f"{address}1/", {"text": "do it", "shown": shown})
    assert Submission.objects.answered().get().seconds is None


def test_scripts_are_shown_and_not_run(launched, client):
    texts = dict.fromkeys(
        ("introduction", "examples", "consent", "thanks", "completion_code"), SCRIPT
    )
    campaign = launched(task_size=1, free_commands=1, name=SCRIPT, **texts)
    address = f"/p/{campaign.key}/"
    pages = [client.get(f"{address}?PROLIFIC_PID={SCRIPT}", follow=True)]
    client.post(address, {"agrees": "on"})
    pages.append(client.post(f"{address}1/", {"text": SCRIPT}, follow=True))
    client.post(f"{address}2/", {"text": SCRIPT, "shown": SCRIPT, "pasted": SCRIPT})
    pages += [client.get(f"{address}2/"), client.get(f"{address}done/")]
    pages.append(client.post(f"{address}done/", {"helped": "no"}, follow=True))
    for page in pages:
        assert page.status_code == 200
        assert SCRIPT not in text_of(page)
    assert sum("&lt;script&gt;" in text_of(page) for page in pages) >= 4


def test_advice_while_one_types(campaign, address):
    client = begun(campaign)
    place = Submission.objects.get(position=1)
    type(place.prompt).objects.filter(pk=place.prompt_id).update(
        shown="bring me the apple from the kitchen table",
        entities=[{"text": "apple", "aliases": [], "is_described": False}],
    )

    def codes(text: str) -> list[str]:
        answer = client.post(f"{address}1/check/", {"text": text})
        return [each["code"] for each in answer.json()["warnings"]]

    assert codes("bring me the apple from the kitchen table") == ["too_close"]
    assert codes("fetch an apple that lies on the table of the kitchen") == []
    assert codes("fetch what lies on the table of the kitchen") == ["lost_entity"]
    assert "too_far" in codes("x" * 200)
    assert codes("") == []
    assert client.post(f"{address}77/check/", {"text": "x"}).json() == {"warnings": []}
    assert not Submission.objects.answered().exists()


def test_words_not_to_use_are_those_that_others_used_most(launched):
    campaign = launched(task_size=1, free_commands=0, taboo_words=2, choice={"prompts_per_form": 1})
    address = f"/p/{campaign.key}/"
    begun(campaign)
    prompt = Submission.objects.get().prompt
    for number in range(3):
        begun(campaign)
        place = Submission.objects.order_by("pk").last()
        Submission.objects.filter(pk=place.pk).update(
            prompt=prompt, text=f"kindly fetch it {number}"
        )
    client = begun(campaign)
    Submission.objects.filter(pk=Submission.objects.order_by("pk").last().pk).update(prompt=prompt)
    assert "Try to say it without: <strong>fetch" in text_of(client.get(f"{address}1/"))


def test_an_account_is_not_linked_with_what_is_written(adam, campaign, address):
    adam.post(address, {"agrees": "on"})
    adam.post(f"{address}1/", {"text": "do it"})
    assert Submission.objects.answered().exists()
    assert not AuditEntry.objects.exists()
