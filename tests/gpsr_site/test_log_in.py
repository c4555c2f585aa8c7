"""Logging in: where it leads, and how often one may get it wrong."""

from __future__ import annotations

import pytest

from annotations.rates import FAILED_LOG_INS
from gpsr_site.accounts import TOO_OFTEN

RIGHT = {"username": "anna", "password": "correct horse"}
WRONG = {**RIGHT, "password": "wrong"}


@pytest.fixture(autouse=True)
def _people(annotator):
    """Somebody who can log in."""


def fail(client, times, **extra):
    for _ in range(times):
        answer = client.post("/login/", WRONG, **extra)
    return answer


def test_the_right_password_leads_to_the_page_that_was_asked_for(client):
    asked = client.get("/w/home/commands/")
    assert asked.url == "/login/?next=/w/home/commands/"
    answer = client.post("/login/", {**RIGHT, "next": "/w/home/commands/"})
    assert answer.url == "/w/home/commands/"


def test_one_is_not_led_to_another_site(client):
    answer = client.post("/login/", {**RIGHT, "next": "https://elsewhere.example/"})
    assert answer.url == "/"


def test_a_wrong_password_is_told_on_the_page(client):
    answer = client.post("/login/", WRONG)
    assert answer.status_code == 200
    assert "correct username and password" in answer.content.decode()


def test_after_too_many_failures_even_the_right_password_waits(client):
    assert fail(client, FAILED_LOG_INS.limit).status_code == 200
    answer = client.post("/login/", RIGHT)
    assert answer.status_code == 429
    assert TOO_OFTEN in answer.content.decode()


def test_spelling_the_name_otherwise_does_not_help(client):
    fail(client, FAILED_LOG_INS.limit)
    assert client.post("/login/", {**RIGHT, "username": " ANNA "}).status_code == 429


def test_somebody_elsewhere_is_not_locked_out(client):
    fail(client, FAILED_LOG_INS.limit)
    assert client.post("/login/", RIGHT, REMOTE_ADDR="192.0.2.7").status_code == 302


def test_a_success_forgets_the_failures(client):
    fail(client, FAILED_LOG_INS.limit - 1)
    assert client.post("/login/", RIGHT).status_code == 302
    client.post("/logout/")
    assert fail(client, FAILED_LOG_INS.limit - 1).status_code == 200


def test_logging_out_takes_a_post(client, annotator):
    client.force_login(annotator)
    assert client.get("/logout/").status_code == 405
    assert client.post("/logout/").url == "/login/"
    assert client.get("/").status_code == 302
