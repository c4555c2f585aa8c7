"""Log lines: no secret stands in them; as JSON they say which request they belong to."""

from __future__ import annotations

import json
import logging
import sys

import pytest

from gpsr_site.logs import REQUEST_ID, HideSecrets, JsonLines


def shown(message: str, *args: object) -> str:
    record = logging.LogRecord("django.request", logging.WARNING, "", 0, message, args, None)
    assert HideSecrets().filter(record)
    return record.getMessage()


@pytest.mark.parametrize("end", ["/", "", "/?next=/"])
def test_the_key_of_an_invitation_is_hidden(end):
    assert shown("%s: %s", "Not Found", f"/join/s3cret-key{end}") == f"Not Found: /join/…{end}"


def test_the_key_of_a_link_for_a_password_is_hidden():
    assert shown("at %s", "/password/MQ/abc-def/") == "at /password/MQ/…/"


def test_other_lines_stay_as_they_are():
    assert shown("%d of %s", 3, "/w/home/join/") == "3 of /w/home/join/"
    assert shown("Gone: %s", "/p/key/?PROLIFIC_PID=5f&x=1") == "Gone: /p/key/?…"


def line(**extra) -> dict[str, object]:
    record = logging.LogRecord("a.b", logging.ERROR, "", 0, "it is “%s”", ("so",), None)
    vars(record).update(extra)
    text = JsonLines().format(record)
    assert "\n" not in text
    return json.loads(text)


def test_a_line_of_json_says_what_happened_in_which_request():
    token = REQUEST_ID.set("r1")
    try:
        values = line(fields={"status": 200})
    finally:
        REQUEST_ID.reset(token)
    assert values.pop("time").endswith("+00:00")
    assert values == {
        **{"level": "ERROR", "logger": "a.b", "message": "it is “so”"},
        **{"status": 200, "request_id": "r1"},
    }


def test_an_error_brings_its_traceback_without_a_secret():
    try:
        raise ValueError("at /join/s3cret/")
    except ValueError:
        values = line(exc_info=sys.exc_info())
    assert "ValueError: at /join/…/" in values["exception"]


def test_the_id_of_a_proxy_is_kept_and_one_is_made_otherwise(client, db):
    assert client.get("/healthz", headers={"x-request-id": "abc-1"})["X-Request-ID"] == "abc-1"
    for odd in ("", "a b", "x" * 65, "ä"):
        made = client.get("/healthz", headers={"x-request-id": odd})["X-Request-ID"]
        assert made != odd and len(made) == 32
    assert REQUEST_ID.get() == ""


def test_each_request_is_a_line_without_its_query(client, db, settings, caplog, annotator):
    settings.LOG_FORMAT = "json"
    caplog.set_level(logging.INFO, "gpsr_site.requests")
    client.force_login(annotator)
    client.get("/join/s3cret/?q=private")
    (record,) = [each for each in caplog.records if each.name == "gpsr_site.requests"]
    fields = record.fields
    assert fields.pop("milliseconds") > 0
    assert fields == {
        **{"method": "GET", "path": "/join/…/", "status": 404},
        **{"address": "127.0.0.1", "user": annotator.pk},
    }


def test_lines_for_people_leave_requests_out(client, db, caplog):
    caplog.set_level(logging.INFO, "gpsr_site.requests")
    client.get("/healthz")
    assert not [each for each in caplog.records if each.name == "gpsr_site.requests"]
