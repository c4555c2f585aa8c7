"""Guidelines for annotators: admins write them, the world reads them, their versions are kept."""

from __future__ import annotations

import json

import pytest

from annotations.models import Guidelines
from annotations.rows.history import history_of
from tests.conftest import client_of

PAGE, ROUTE = "/w/home/guidelines/", "/api/v1/worlds/home/guidelines/"


@pytest.fixture
def adam(admin):
    return client_of(admin)


@pytest.fixture
def anna(annotator):
    return client_of(annotator)


def write(client, text, version=""):
    return client.post(PAGE, {"text": text, "version": version, "once": ""})


def test_admins_write_and_the_world_reads(adam, anna, world):
    assert write(anna, "No.").status_code == 403
    assert write(adam, "# Say *bring*").url == PAGE
    assert "<h3>Say <em>bring</em></h3>" in anna.get(PAGE).content.decode()
    assert "guidelines-form" not in anna.get(PAGE).content.decode()
    assert "<h3>Say <em>bring</em></h3>" in anna.get("/w/home/label/").content.decode()
    assert write(adam, "Say take.", 1).status_code == 302
    row = Guidelines.objects.get()
    assert (row.text, row.version) == ("Say take.", 2)


def test_what_is_too_long_is_refused_and_not_made_html(adam, world, monkeypatch):
    made = []
    monkeypatch.setattr("annotations.web.description.guidelines_pages.rendered", made.append)
    page = write(adam, "# Say *bring*\n" * 2_000)
    assert page.status_code == 200 and not Guidelines.objects.exists()
    assert made == [""]


def test_an_empty_page_says_who_writes(anna, adam, world):
    page = anna.get(PAGE).content.decode()
    assert '<div class="empty">' in page and "guidelines-form" not in page
    assert "data-guidelines" in anna.get("/w/home/label/").content.decode()
    assert "guidelines-form" in adam.get(PAGE).content.decode()


def test_whoever_saves_second_merges(adam, world):
    write(adam, "one")
    write(adam, "two", 1)
    clash = write(adam, "three", 1)
    assert clash.status_code == 409
    assert Guidelines.objects.get().text == "two"


def test_a_version_is_restored_by_admins_alone(adam, anna, world):
    write(adam, "one")
    write(adam, "two", 1)
    row = Guidelines.objects.get()
    first = history_of(Guidelines).filter(id=row.pk).earliest("history_id")
    page, route = (
        f"/w/home/history/guidelines/{row.pk}/",
        f"/api/v1/worlds/home/history/guidelines/{row.pk}/",
    )
    sent = {"entry": first.history_id}
    assert anna.post(page, sent).status_code == 403
    assert anna.post(route, json.dumps(sent), content_type="application/json").status_code == 403
    assert 'name="entry"' not in anna.get(page).content.decode()
    assert 'name="entry"' in adam.get(page).content.decode()
    assert adam.post(page, sent).status_code == 302
    row.refresh_from_db()
    assert (row.text, row.version) == ("one", 3)
    assert adam.get(f"{page}delete/").status_code == 404


def test_the_route_needs_the_version(adam, anna, world):
    def patch(client, text, tag):
        return client.patch(
            ROUTE,
            json.dumps({"text": text}),
            content_type="application/json",
            headers={"if-match": tag} if tag else {},
        )

    empty = anna.get(ROUTE)
    assert empty.json() == {"id": None, "text": "", "html": "", "version": 0}
    assert patch(anna, "no", empty["ETag"]).status_code == 403
    assert patch(adam, "one", "").status_code == 428
    first = patch(adam, "*one*", empty["ETag"])
    assert first.json()["html"] == "<p><em>one</em></p>\n" and first.json()["version"] == 1
    assert patch(adam, "two", empty["ETag"]).status_code == 412
    assert patch(adam, "x" * 20_001, first["ETag"]).status_code == 400
    assert patch(adam, "two", first["ETag"]).json()["version"] == 2


def test_a_preview_stores_nothing(adam, world):
    answer = adam.post(f"{PAGE}preview/", {"text": "**now**"})
    assert "<strong>now</strong>" in answer.content.decode()
    assert not Guidelines.objects.exists()
