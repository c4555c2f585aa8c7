"""Addresses of the API, types of bodies, and what the schema says of fields."""

from __future__ import annotations

import json

import pytest

from annotations.models import ApiToken
from annotations.web.rest.streaming import JSON_LINES_TYPES
from gpsr_site.web.thread_shares import SlowKind, kind_of

PARSE = "/api/v1/worlds/home/parse/"


@pytest.fixture
def headers(annotator) -> dict[str, str]:
    _, key = ApiToken.issue(annotator, "robot", scope="annotate")
    return {"authorization": f"Bearer {key}"}


def test_a_post_without_the_last_slash_does_its_work(sample, client, headers):
    sent = {"pattern": "find the {object}"}
    answers = [
        client.post(
            f"/api/v1/worlds/home/check/template{slash}", sent, "application/json", headers=headers
        )
        for slash in ("", "/")
    ]
    assert answers[0].status_code == answers[1].status_code == 400
    assert answers[0].json() == answers[1].json()
    assert client.get("/api/v1/worlds", headers=headers).status_code == 200
    assert client.get("/api/v1/nothing", headers=headers).status_code == 404


def test_a_request_without_the_last_slash_has_the_same_share(sample):
    for kind in JSON_LINES_TYPES:
        assert kind_of("POST", PARSE, kind) is SlowKind.BATCH
        assert kind_of("POST", PARSE.rstrip("/"), kind) is SlowKind.BATCH


def test_the_root_lists_what_is_there(sample, client):
    root = client.get("/api/v1/").json()
    assert root["addresses"]["/api/v1/worlds/{world}/parse/"] == ["POST"]
    assert {"GET", "POST"} <= set(root["addresses"]["/api/v1/worlds/"])
    assert client.get(root["schema"]).status_code == 200
    schema = json.loads(client.get(root["schema"], headers={"accept": "application/json"}).content)
    not_described = {"/api/v1/", root["schema"]}
    assert set(root["addresses"]) - not_described == set(schema["paths"])


@pytest.mark.parametrize("path", [PARSE, f"{PARSE}jobs/"])
def test_a_type_that_is_not_taken_is_answered_with_those_that_are(sample, client, headers, path):
    answer = client.post(path, "a", "text/plain", headers=headers)
    assert (answer.status_code, answer.json()["code"]) == (415, "unsupported_media_type")
    assert all(each in answer.json()["detail"] for each in JSON_LINES_TYPES)
    for kind in JSON_LINES_TYPES:
        assert client.post(path, "", kind, headers=headers).status_code != 415


def test_an_unknown_field_is_answered_with_those_that_are_known(sample, client, headers):
    answer = client.post(PARSE, {"uterance": "go"}, "application/json", headers=headers)
    (problem,) = answer.json()["problems"]
    assert problem["field"] == "uterance"
    assert all(each in problem["message"] for each in ("utterance", "beam", "alternatives"))
