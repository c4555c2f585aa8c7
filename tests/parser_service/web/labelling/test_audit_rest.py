"""/api/v1/worlds/<w>/audit/, audit-findings/<id>/decide/ and audit-decisions/<id>/take-back/"""

from __future__ import annotations

import pytest

from annotations.labelling.audit_findings import store_findings
from annotations.models import Job
from tests.doubted_labels import FEMALE, MALE, doubt, say

HOME = "worlds/home/"


@pytest.fixture
def call_as(call_as, monkeypatch):
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    return lambda user, method, path, data=None: call_as(user, method, HOME + path, data)


@pytest.fixture
def finding(world):
    store_findings(world, [doubt(say(world, "how many girls are in the kitchen"))])
    return world.audit_findings.get()


def test_an_audit_is_started_once(call_as, world, reviewer, annotator):
    nothing = call_as(annotator, "get", "audit/").json()
    assert nothing == {"job": None, "precision": None}
    sent = {"parser": "knn", "folds": 3, "to_queue": 0}
    assert call_as(annotator, "post", "audit/", sent).status_code == 403
    assert call_as(reviewer, "post", "audit/", {**sent, "folds": 1}).status_code == 400
    assert call_as(reviewer, "post", "audit/", {**sent, "parser": "moon"}).status_code == 400
    started = call_as(reviewer, "post", "audit/", sent)
    assert (started.status_code, started.json()["kind"]) == (202, "audit")
    assert started["Location"].endswith(f"/api/v1/worlds/home/jobs/{started.json()['id']}/")
    assert call_as(reviewer, "post", "audit/", sent).json()["id"] == started.json()["id"]
    assert Job.objects.get().arguments == sent
    assert call_as(annotator, "get", "audit/").json()["job"]["status"] == "queued"


def test_a_label_is_decided_and_the_decision_taken_back(call_as, finding, reviewer, annotator):
    address = f"audit-findings/{finding.pk}/decide/"
    assert call_as(reviewer, "post", address, {"decision": "forgotten"}).status_code == 400
    wrong = call_as(reviewer, "post", address, {"decision": "corrected", "form": "(go"})
    assert wrong.json()["problems"][0]["field"] == "form"
    sent = {"decision": "corrected", "reason": "Girls are asked for."}
    decided = call_as(reviewer, "post", address, sent).json()
    assert (decided["status"], decided["decided_form"]) == ("corrected", FEMALE)
    assert call_as(reviewer, "post", address, sent).status_code == 409
    precision = call_as(reviewer, "get", "audit/").json()["precision"]
    assert (precision["corrected"], precision["share"]) == (1, 1.0)
    finding.paraphrase.refresh_from_db()
    assert finding.paraphrase.logical_form == FEMALE
    (made,) = decided["decisions"]
    back = f"audit-decisions/{made['id']}/take-back/"
    assert call_as(annotator, "post", back).status_code == 409
    assert call_as(reviewer, "post", back).json()["status"] == "open"
    finding.paraphrase.refresh_from_db()
    assert finding.paraphrase.logical_form == MALE


def test_decisions_of_other_worlds_are_not_there(call_as, finding, stranger, reviewer):
    assert call_as(reviewer, "post", "audit-findings/1000000/decide/", {}).status_code == 404
    assert call_as(reviewer, "post", "audit-decisions/1000000/take-back/").status_code == 404
    sent = {"decision": "kept"}
    away = call_as(stranger, "post", f"audit-findings/{finding.pk}/decide/", sent)
    assert away.status_code == 404
