"""/api/v1/worlds/<w>/audit-findings/"""

from __future__ import annotations

import pytest

from annotations.labelling.audit_findings import store_findings
from annotations.labelling.giving import next_item
from annotations.labelling.label_decisions import decide
from annotations.language.corpus.label_errors import Reason
from annotations.models import ApiToken, FindingStatus
from tests.doubted_labels import FEMALE, MALE, doubt, say

ALL = "/api/v1/worlds/home/audit-findings/"


@pytest.fixture
def rows(tiny_world):
    rows = [say(tiny_world, f"how many girls {number}") for number in range(2)]
    store_findings(tiny_world, [doubt(rows[1]), doubt(rows[0], FEMALE, Reason.WORD)], to_queue=2)
    return rows


@pytest.fixture
def call(caller, annotator):
    return lambda path="": caller(ALL + path, annotator)


def test_the_rows_are_those_of_the_page(call, rows, anna):
    results = call().json()["results"]
    listed = anna.get("/w/home/audit/").context["listing"].rows
    assert [row["id"] for row in results] == [row.pk for row in listed]
    assert results[0]["subject"] == {"kind": "paraphrase", "id": rows[1].pk}
    assert (results[0]["form"], results[0]["suggested_form"]) == (MALE, FEMALE)
    assert results[0]["reasons"][0]["sentence"] == "The command says so."
    assert call(f"{results[0]['id']}/").json() == results[0]


def test_the_list_is_filtered(call, rows, annotator):
    decide(rows[0].audit_findings.get(), FindingStatus.KEPT, annotator, reason="fine")
    (kept,) = call("?status=kept&reason=word").json()["results"]
    assert kept["decisions"][0]["decided_by"] == "anna"
    assert kept["decisions"][0]["reason"] == "fine"
    assert call("?status=open&reason=word").json()["results"] == []
    assert call("?status=late").status_code == 400


@pytest.mark.parametrize(
    ("answer", "status"),
    [
        ({}, "kept"),
        ({"verdict": "form", "form": FEMALE}, "corrected"),
        ({"verdict": "exclude", "reason": "no command"}, "excluded"),
        ({"verdict": "skip"}, "open"),
    ],
)
def test_whoever_ends_the_item_decides(answer, status, client, tiny_world, rows, annotator):
    _, key = ApiToken.issue(annotator, "notebook")
    item = next_item(annotator, tiny_world).item
    client.post(
        f"/api/v1/worlds/home/work-items/{item.pk}/finish/",
        answer,
        content_type="application/json",
        headers={"authorization": f"Bearer {key}"},
    )
    assert rows[1].audit_findings.get().status == status
    item.refresh_from_db()
    assert item.is_open == (status == "open")
