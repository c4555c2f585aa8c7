"""/api/v1/worlds/<w>/parse/wrong/, suggestions/ and splits/<s>/examples/<e>/send/"""

from __future__ import annotations

import pytest

from annotations.models import Proposal, Utterance, WorkItem

HOME = "worlds/home/"
GO = '( go " <room> " )'


@pytest.fixture
def call_as(call_as, monkeypatch):
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    return lambda user, path, data: call_as(user, "post", HOME + path, data)


def test_a_wrong_answer_is_sent_to_the_work_queue(call_as, sample, reviewer):
    sent = {"utterance": "off to bed", "run": sample.run.pk, "form": GO, "reason": "Nobody knew."}
    said = call_as(reviewer, "parse/wrong/", sent).json()["sentence"]
    item = WorkItem.objects.get()
    assert item.reason.startswith("rene ") and item.reason.endswith(" Nobody knew.")
    assert f" Nearest neighbour (run {sample.run.pk}) " in item.reason
    assert (item.utterance.text, Proposal.objects.get().form) == ("off to bed", GO)
    refused = call_as(reviewer, "parse/wrong/", {**sent, "form": "(go"})
    assert refused.json()["problems"][0]["field"] == "form"
    assert call_as(reviewer, "parse/wrong/", {**sent, "run": 10**6}).status_code == 404
    again = call_as(reviewer, "parse/wrong/", {"utterance": "off to bed"}).json()["sentence"]
    assert said and again and again != said
    assert WorkItem.objects.get() == item


def test_forms_are_suggested_for_a_pattern(call_as, sample, annotator):
    sent = {"task_category": "1", "pattern": "walk to the {room}"}
    answer = call_as(annotator, "suggestions/", sent).json()
    assert "(go {room})" in [each["form"] for each in answer["forms"]]
    assert answer["forms"][0]["english"]
    other = call_as(annotator, "suggestions/", {**sent, "task_category": "9"})
    assert other.json()["problems"][0]["field"] == "task_category"


def test_an_example_is_sent_to_the_work_queue(call_as, sample, reviewer, annotator):
    address = f"splits/{sample.split.pk}/examples/{sample.example.pk}/send/"
    sent = {"reason": "Is this said?"}
    assert call_as(annotator, address, sent).status_code == 403
    done = call_as(reviewer, address, sent)
    assert done.json() == {"utterances": 1, "subjects": 1, "queued": 1, "left_out": 0}
    reason = WorkItem.objects.get().reason
    assert reason.startswith("rene ") and reason.endswith(" Is this said?")
    assert Utterance.objects.get().text == " ".join(sample.example.utterance.split())
    missing = f"splits/{sample.split.pk}/examples/1000000/send/"
    assert call_as(reviewer, missing, sent).status_code == 404
