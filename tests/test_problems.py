"""Each refusal of the API has a code for programs, and the document of problems lists all of them."""

from __future__ import annotations

import re

import pytest

from annotations.models import ApiToken
from annotations.web.problems import TYPES
from tests.problem_page import PAGE, print_page, read_codes


def is_problem(answer, status: int, code: str) -> bool:
    """Return whether an answer is a problem document with a code that is listed."""
    document = answer.json()
    said = document["status"], document["code"], document["type"]
    return (
        answer["Content-Type"] == "application/problem+json"
        and answer.status_code == status
        and said == (status, code, f"{TYPES}{code}")
        and code in read_codes()
        and bool(document["title"] and document["detail"])
    )


def test_the_document_has_every_code_of_the_program():
    codes = read_codes()
    assert len(codes) > 149
    assert all(code.sentences and code.statuses for code in codes.values())
    page = PAGE.read_text(encoding="utf-8")
    assert re.findall(r"^## (\w+)$", page, re.MULTILINE) == list(codes)
    assert page == print_page(codes), "write it anew: python -m tests.problem_page"


@pytest.fixture
def ask(client, annotator):
    """Returns a function that asks with a token."""
    _, key = ApiToken.issue(annotator, "robot", scope="annotate")

    def send(
        method: str, path: str, body: str = "", content_type: str = "application/json", **headers
    ):
        headers = {"authorization": f"Bearer {key}", **headers}
        return client.generic(
            method, f"/api/v1/{path}", body, content_type=content_type, headers=headers
        )

    return send


@pytest.mark.parametrize(
    ("method", "path", "body", "content_type", "status", "code"),
    [
        ("GET", "worlds/nowhere/", "", "", 404, "not_found"),
        ("GET", "worlds/home/templates/9999/", "", "", 404, "not_found"),
        ("GET", "no/such/address/", "", "", 404, "not_found"),
        ("PUT", "worlds/home/templates/", "{}", "application/json", 405, "method_not_allowed"),
        ("POST", "worlds/home/templates/", "a,b", "text/csv", 415, "unsupported_media_type"),
        ("POST", "worlds/home/templates/", "{", "application/json", 400, "parse_error"),
        ("POST", "worlds/home/templates/", "{}", "application/json", 400, "not_valid"),
        ("POST", "worlds/home/templates/", '{"pattrn": ""}', "application/json", 400, "not_valid"),
        (
            "POST",
            "worlds/home/templates/",
            '{"pattern": "a\\u0000"}',
            "application/json",
            400,
            "not_text",
        ),
    ],
)
def test_what_the_framework_refuses_has_a_code(
    sample, ask, method, path, body, content_type, status, code
):
    answer = ask(method, path, body, content_type)
    assert is_problem(answer, status, code), answer.content


def test_who_may_not_is_told_so_by_code(sample, client, ask):
    assert is_problem(client.get("/api/v1/worlds/home/"), 401, "not_authenticated")
    wrong = client.get("/api/v1/worlds/home/", headers={"authorization": "Bearer wrong"})
    assert is_problem(wrong, 401, "authentication_failed")
    assert is_problem(ask("DELETE", "worlds/home/", **{"if-match": "*"}), 403, "permission_denied")


def test_a_write_without_its_version_and_one_that_is_late_have_codes(sample, ask):
    rows = ask("GET", "worlds/home/entities/").json()["results"]
    address = f"worlds/home/entities/{rows[0]['id']}/"
    assert is_problem(ask("PATCH", address, "{}"), 428, "precondition_required")
    late = ask("PATCH", address, '{"text": "mate"}', **{"if-match": '"0"'})
    assert is_problem(late, 412, "overtaken")
    assert late.json()["current"]["id"] == rows[0]["id"]


def test_a_fault_of_the_server_has_a_code(sample, client, annotator, monkeypatch):
    _, key = ApiToken.issue(annotator, "robot", scope="read")
    client.raise_request_exception = False

    def fail(*_):
        raise ZeroDivisionError

    monkeypatch.setattr("annotations.web.worlds.world_rest.OneWorld.get", fail)
    answer = client.get("/api/v1/worlds/home/", headers={"authorization": f"Bearer {key}"})
    assert is_problem(answer, 500, "server_error")


def test_a_problem_of_a_text_keeps_its_place_and_its_code(sample, ask):
    sent = '{"task_category": "1", "pattern": "go to the {room}", "form": "(go {room}"}'
    answer = ask("POST", "worlds/home/templates/", sent)
    assert answer.status_code == 400 and answer.json()["code"] in read_codes()
    assert answer.json()["problems"][0]["field"] == "form"
    assert answer.json()["problems"][0]["line"] == 1
