"""What people see instead of the page they asked for: in plain words, in the frame where there is one."""

from __future__ import annotations

import base64
import hashlib
import logging
import re
import urllib.error
import urllib.request
from contextlib import contextmanager

import pytest
from django.db import InterfaceError, OperationalError
from django.test import Client

from gpsr_site.logs import RefusedInOneLine
from gpsr_site.web.error_pages import is_outage


@contextmanager
def database_away(monkeypatch):
    """Make every query fail as it does when the database is away."""

    def fail(*args, **kwargs):
        raise InterfaceError("connection already closed")

    with monkeypatch.context() as patch:
        patch.setattr("django.db.backends.utils.CursorWrapper.execute", fail)
        yield


@pytest.fixture
def visitor(client):
    client.raise_request_exception = False
    return client


def test_a_refusal_keeps_the_frame_and_says_whom_to_ask(sample, annotator, admin, client):
    client.force_login(annotator)
    answer = client.get("/w/home/runs/new/")
    page = answer.content.decode()
    assert answer.status_code == 403
    main = page.partition('<main id="main"')[2]
    assert answer.context["sentence"] in main and "adam" in main
    assert 'href="/w/home/people/"' in main and 'href="/w/home/"' in main
    assert 'id="rail"' in page and "/w/home/templates/" in page


def test_a_refusal_outside_of_any_world_leads_back_to_the_worlds(annotator, client):
    client.force_login(annotator)
    answer = client.get("/worlds/new/")
    main = answer.content.decode().partition('<main id="main"')[2]
    assert answer.status_code == 403
    assert answer.context["sentence"] in main and 'href="/"' in main


@pytest.mark.parametrize("path", ["nowhere/", "templates/999999/", "runs/0/"])
def test_a_missing_page_of_a_world_keeps_its_rail(path, sample, annotator, client):
    client.force_login(annotator)
    answer = client.get(f"/w/home/{path}")
    page = answer.content.decode()
    assert answer.status_code == 404
    main = page.partition('<main id="main"')[2]
    assert answer.context["sentence"] in main and 'href="/w/home/"' in main
    assert "/w/home/templates/" in page


@pytest.mark.parametrize("path", ["", "nowhere/", "templates/1/"])
def test_a_world_of_others_does_not_show_that_it_exists(path, world, stranger, client):
    client.force_login(stranger)
    answers = [client.get(f"/w/{name}/{path}") for name in ("home", "none")]
    pages = [answer.content.decode().replace("/w/none/", "/w/home/") for answer in answers]
    assert "A flat with one robot" not in pages[0]
    without_nonce = [page.split('nonce="')[0] + page.split("</head>")[1] for page in pages]
    bodies = [page.split('<main id="main"')[1] for page in without_nonce]
    assert answers[0].status_code == answers[1].status_code == 404
    assert bodies[0] == bodies[1]


def test_a_stranger_to_the_site_gets_no_rail(db, client):
    answer = client.get("/nowhere/")
    assert answer.status_code == 404
    assert 'id="rail"' not in answer.content.decode()


def test_an_address_of_the_api_answers_as_the_api_does(db, client):
    answer = client.get("/api/v1/nowhere/")
    assert (answer.status_code, answer["Content-Type"]) == (404, "application/problem+json")
    assert answer.json()["status"] == 404 and "/api/v1/nowhere/" in answer.json()["detail"]


@pytest.mark.parametrize("path", ["/", "/w/home/", "/w/home/templates/", "/login/", "/healthz"])
def test_while_the_database_is_away_pages_say_so_and_when_to_come_back(
    path, annotator, world, visitor, monkeypatch
):
    if path != "/login/":
        visitor.force_login(annotator)
    with database_away(monkeypatch):
        asked = visitor.post if path == "/login/" else visitor.get
        answer = asked(path, {"username": "a", "password": "b"})
    assert answer.status_code == 503
    assert answer["Retry-After"] == "10"
    assert "<h1>" in answer.content.decode()


def test_an_error_of_the_program_is_a_500_in_plain_words(annotator, visitor, monkeypatch):
    def fail(*args):
        raise ZeroDivisionError

    monkeypatch.setattr("gpsr_site.pages.home_pages.counts_of_all", fail)
    visitor.force_login(annotator)
    answer = visitor.get("/")
    assert answer.status_code == 500
    assert "<h1>" in answer.content.decode() and "ZeroDivisionError" not in answer.content.decode()


@pytest.fixture
def broken_manifest(settings, tmp_path):
    """Static files that were never collected: every page that names one fails."""
    manifest = {"BACKEND": "whitenoise.storage.CompressedManifestStaticFilesStorage"}
    settings.STATIC_ROOT = tmp_path
    settings.STORAGES = {**settings.STORAGES, "staticfiles": manifest}


@pytest.mark.parametrize("path", ["/login/", "/nowhere/", "/static/dist/main.css"])
def test_without_static_files_people_get_the_page_that_needs_none(
    path, db, visitor, broken_manifest
):
    answer = visitor.get(path)
    page = answer.content.decode()
    assert answer.status_code == 500
    assert "<h1>" in page and "/static/" not in page


def test_without_static_files_and_database_people_are_told_when_to_come_back(
    annotator, visitor, broken_manifest, monkeypatch
):
    visitor.force_login(annotator)
    with database_away(monkeypatch):
        answer = visitor.get("/")
    assert (answer.status_code, answer["Retry-After"]) == (503, "10")
    assert "<h1>" in answer.content.decode()


def test_the_web_server_answers_without_static_files_and_database(
    site, broken_manifest, monkeypatch
):
    with database_away(monkeypatch), pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(f"http://127.0.0.1:{site.port}/healthz", timeout=20)
    assert refused.value.code == 503
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(f"http://127.0.0.1:{site.port}/login/", timeout=20)
    assert refused.value.code == 500
    assert "<h1>" in refused.value.read().decode()


def test_browsers_may_use_the_style_of_that_page(db, visitor, broken_manifest):
    answer = visitor.get("/login/")
    style = re.search("<style>(.*)</style>", answer.content.decode())[1]
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    assert f"'sha256-{digest}'" in answer["Content-Security-Policy"]


class FromPostgres(Exception):
    def __init__(self, sqlstate):
        self.sqlstate = sqlstate


@pytest.mark.parametrize(
    ("sqlstate", "expected"),
    [(None, True), ("57P01", True), ("57014", True), ("53300", True), ("22003", False)],
)
def test_an_outage_of_postgresql_is_known_by_its_code(sqlstate, expected):
    error = OperationalError("…")
    error.__cause__ = FromPostgres(sqlstate)
    assert is_outage(error) is expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [("database is locked", True), ("too many SQL variables", False), ("disk I/O error", True)],
)
def test_an_outage_of_sqlite_is_known_by_its_words(text, expected):
    assert is_outage(OperationalError(text)) is expected


def test_a_form_without_its_token_is_told_in_a_sentence(annotator):
    client = Client(enforce_csrf_checks=True)
    answer = client.post("/login/", {"username": "anna", "password": "correct horse"})
    assert answer.status_code == 403
    assert answer.templates[0].name == "error.html" and "Referer" not in answer.content.decode()


def test_another_host_is_refused_in_plain_words(db, client):
    answer = client.get("/", HTTP_HOST="elsewhere.example")
    assert answer.status_code == 400
    assert answer.templates[0].name == "error.html"
    assert "ALLOWED_HOSTS" in answer.content.decode()


def test_django_s_admin_has_the_icon_of_the_workbench(superuser, client):
    client.force_login(superuser)
    assert "favicon.svg" in client.get("/admin/").content.decode()


@pytest.mark.parametrize(
    "origin",
    ["https://testserver", "http://lab.example.org", "https://lab.example.org:8443", "null"],
)
def test_a_form_of_another_address_is_told_both_addresses_and_what_to_set(origin, db):
    browser = Client(enforce_csrf_checks=True)
    page = browser.get("/login/").content.decode()
    token = re.search(r'name="csrfmiddlewaretoken" value="(\w+)"', page)[1]
    sent = {"username": "anna", "password": "x", "csrfmiddlewaretoken": token}
    answer = browser.post("/login/", sent, headers={"origin": origin})
    said = answer.content.decode()
    assert answer.status_code == 403
    assert origin in said and "http://testserver" in said
    assert all(name in said for name in ("HTTPS", "ALLOWED_HOSTS", "CSRF_TRUSTED_ORIGINS"))
    # A form without its cookie is an old one, as before.
    old = Client(enforce_csrf_checks=True).post(
        "/login/", sent, headers={"origin": "http://testserver"}
    )
    assert old.status_code == 403 and "ALLOWED_HOSTS" not in old.content.decode()


@pytest.mark.parametrize("address", ["127.0.0.1", "192.0.2.9"])
@pytest.mark.parametrize("path", ["/login/", "/api/v1/worlds/"])
def test_another_name_of_the_site_is_told_and_its_own_only_here(path, address, settings, caplog):
    settings.ALLOWED_HOSTS = ["lab.example.org"]
    headers = {"host": "robot.local:8000"}
    answer = Client(REMOTE_ADDR=address).get(path, headers=headers)
    said = answer.content.decode()
    assert answer.status_code == 400 and "ALLOWED_HOSTS" in said
    assert ("lab.example.org" in said) is (address == "127.0.0.1")
    (record,) = [each for each in caplog.records if each.name.startswith("django.security")]
    assert RefusedInOneLine().filter(record)
    assert "Traceback" not in logging.Formatter().format(record)
