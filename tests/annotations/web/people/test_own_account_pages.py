"""One's own account: tokens are shown once and ended by their owner alone; so are log-ins."""

from __future__ import annotations

import pytest
from django.test import Client

from annotations.models import ApiToken, LogInSession
from annotations.templatetags.devices import device
from annotations.web.people.token_forms import MOST_TOKENS
from tests.conftest import client_of

SENT = {"name": "robot", "scope": "read", "days": "30"}
FIREFOX = "Mozilla/5.0 (X11; Linux x86_64; rv:128.0) Gecko/20100101 Firefox/128.0"


def test_a_token_is_shown_once_and_works(anna, client, world):
    answer = anna.post("/account/tokens/new/", SENT, follow=True)
    assert answer.redirect_chain == [("/account/", 302)]
    key = answer.context["key"]
    assert key in answer.content.decode() and "no-store" in answer["Cache-Control"]
    page = anna.get("/account/").content.decode()
    assert "robot" in page and key not in page
    headers = {"authorization": f"Bearer {key}"}
    assert client.get("/api/v1/worlds/home/utterances/", headers=headers).status_code == 200


@pytest.mark.parametrize(
    ("field", "value"),
    [("name", ""), ("scope", "root"), ("days", "0"), ("days", "366"), ("days", "x")],
)
def test_what_no_token_can_be_is_refused(field, value, anna):
    answer = anna.post("/account/tokens/new/", {**SENT, field: value})
    assert answer.status_code == 422 and field in answer.context["form"].errors
    assert not ApiToken.objects.exists()


def test_nobody_has_tokens_without_end(anna, annotator):
    for number in range(MOST_TOKENS):
        ApiToken.issue(annotator, f"token {number}")
    answer = anna.post("/account/tokens/new/", SENT)
    assert answer.status_code == 422 and "Revoke one" in answer.content.decode()


def test_a_revoked_token_opens_nothing(anna, annotator):
    token, key = ApiToken.issue(annotator, "robot")
    assert anna.post(f"/account/tokens/{token.pk}/revoke/").url == "/account/"
    assert ApiToken.objects.for_key(key) is None


def test_nobody_sees_or_ends_the_tokens_of_others(rene, annotator):
    token, _ = ApiToken.issue(annotator, "secret project")
    assert "secret project" not in rene.get("/account/").content.decode()
    assert rene.post(f"/account/tokens/{token.pk}/revoke/").status_code == 404


def log_in(**headers) -> Client:
    client = Client(headers=headers)
    client.post("/login/", {"username": "anna", "password": "correct horse"})
    return client


def test_one_sees_where_one_is_logged_in_and_no_key(annotator):
    here, there = log_in(**{"user-agent": FIREFOX}), log_in()
    page = there.get("/account/").content.decode()
    assert "Firefox on Linux" in page and page.count("Log out in") == 2
    for each in (here, there):
        assert each.session.session_key not in page


def test_one_ends_a_log_in_elsewhere(annotator):
    here, there = log_in(), log_in()
    handle = LogInSession.objects.get(pk=there.session.session_key).handle
    here.post(f"/account/sessions/{handle}/end/")
    assert here.get("/account/").status_code == 200
    assert there.get("/account/").status_code == 302


def test_nobody_ends_the_log_in_of_others(anna, rene, annotator):
    handle = LogInSession.objects.get(user=annotator).handle
    rene.post(f"/account/sessions/{handle}/end/")
    assert anna.get("/account/").status_code == 200


def test_logging_out_everywhere_ends_every_log_in_of_oneself(annotator, rene):
    here, there = log_in(), log_in()
    assert here.post("/account/sessions/end/").url == "/login/"
    assert [each.get("/account/").status_code for each in (here, there, rene)] == [302, 302, 200]


def test_a_new_password_ends_the_log_ins_elsewhere(annotator, anna):
    client_of(annotator)
    new = "a battery staple"
    sent = {"old_password": "correct horse", "new_password1": new, "new_password2": new}
    assert anna.post("/password/", sent).url == "/account/"
    assert anna.get("/account/").content.decode().count("Log out in") == 1


@pytest.mark.parametrize(
    ("header", "name"),
    [
        (FIREFOX, "Firefox on Linux"),
        ("Mozilla/5.0 (Windows NT 10.0) Chrome/126 Safari/537.36 Edg/126", "Edge on Windows"),
        ("Mozilla/5.0 (iPhone; CPU iPhone OS 17_5 like Mac OS X) Safari/604.1", "Safari on iOS"),
        ("Mozilla/5.0 (Linux; Android 14) Chrome/126 Mobile Safari/537.36", "Chrome on Android"),
        ("curl/8.5", "A browser"),
        ("", "A browser"),
    ],
)
def test_browsers_have_names(header, name):
    assert device(header) == name
