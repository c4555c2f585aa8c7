"""/api/v1/worlds/<w>/uploads/, and utterances deleted and restored by programs."""

from __future__ import annotations

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label
from annotations.models import Utterance, Verdict

JSONL = '{"text": "go"}\n{"text": "come"}\n'


@pytest.fixture
def send(call_as, tiny_world, annotator):
    """A function: the answer to an upload of a file by the annotator."""

    def post(name: str, data: bytes, **fields: object):
        files = {"file": SimpleUploadedFile(name, data), **fields}
        return call_as(annotator, "post", "worlds/home/uploads/", files=files)

    return post


def test_a_preview_stores_nothing(send, tiny_world):
    answer = send("said.csv", b"Nr;Command\n1;go home\n2;find it\n", preview="true")
    shown = answer.json()
    assert (answer.status_code, shown["upload"]) == (200, None)
    assert (shown["format"], shown["column"], shown["new"]) == ("csv", "Command", 2)
    assert [row["text"] for row in shown["first"]] == ["go home", "find it"]
    assert not tiny_world.utterances.exists()


def test_an_upload_is_listed_undone_and_redone(send, call_as, tiny_world, annotator):
    answer = send("said.jsonl", JSONL.encode())
    upload = answer.json()["upload"]
    assert (answer.status_code, upload["added"]) == (201, 2)
    path = f"worlds/home/uploads/{upload['id']}/"
    assert call_as(annotator, "get", "worlds/home/uploads/").json()["results"] == [upload]
    label(tiny_world.utterances.first(), Verdict.UNKNOWN, "", annotator, 1)
    assert call_as(annotator, "post", f"{path}undo/", {}).status_code == 409
    undone = call_as(annotator, "post", f"{path}undo/", {"labelled": "delete"}).json()
    assert (undone["changed"], undone["upload"]["undone_by"]) == (2, "anna")
    assert call_as(annotator, "post", f"{path}undo/", {}).status_code == 409
    assert call_as(annotator, "post", f"{path}redo/").json()["changed"] == 2
    assert tiny_world.utterances.filter(status="unknown").count() == 1


def test_the_name_of_a_file_is_normalised(send):
    assert send("cafe\u0301.txt", b"go home\n").json()["upload"]["file_name"] == "caf\u00e9.txt"


def test_what_is_answered_while_an_upload_is_undone_stays(
    send, call_as, tiny_world, annotator, monkeypatch
):
    upload = send("said.jsonl", JSONL.encode()).json()["upload"]
    label(tiny_world.utterances.first(), Verdict.UNKNOWN, "", annotator, 1)
    count = "annotations.web.corpus.upload_rest.count_labelled"
    monkeypatch.setattr(count, lambda upload: 0)  # as it was a moment before
    undone = call_as(annotator, "post", f"worlds/home/uploads/{upload['id']}/undo/", {}).json()
    assert undone["changed"] == 1
    assert tiny_world.utterances.get().status == "unknown"


@pytest.mark.parametrize(
    ("name", "data", "fields", "field"),
    [
        ("a.xlsx", b"PK\x03\x04", {}, "file"),
        ("a.csv", b"1;go home now\n2;find it\n", {}, "column"),
        ("a.csv", "Nr;text\n1;für\n".encode("cp1252"), {}, "encoding"),
        ("a.txt", b"$Main = go", {}, "file"),
        ("a.csv", b"id;text\n1;go\n", {"column": "said"}, "file"),
        ("a.csv", b"go", {"format": "excel"}, "format"),
    ],
)
def test_what_is_not_clear_is_refused_with_what_to_say(send, tiny_world, name, data, fields, field):
    answer = send(name, data, **fields)
    assert answer.status_code == 400
    assert answer.json()["problems"][0]["field"] == field
    assert not tiny_world.utterances.exists()


def test_what_is_said_is_done(send, tiny_world):
    assert (
        send("a.csv", b"1;go\n2;find it\n", column="column 2", has_head="false").status_code == 201
    )
    assert (
        send("a.csv", "Nr;text\n1;für\n".encode("cp1252"), encoding="windows-1252").status_code
        == 201
    )
    assert send("a.jsonl", JSONL.encode(), format="text").status_code == 201
    assert tiny_world.utterances.filter(text="für").exists()
    assert tiny_world.utterances.filter(text='{"text": "go"}').exists()


def test_a_row_that_cannot_be_stored_refuses_all_unless_it_may_be_left_out(send, tiny_world):
    data = b'{"text": "go"}\n{"text"\n'
    assert send("a.jsonl", data).json()["problems"][0]["line"] == 2
    assert send("a.jsonl", data, skips_bad="true").json()["new"] == 1
    assert tiny_world.utterances.count() == 1


def test_forms_are_labels_for_admins_alone(send, call_as, tiny_world, admin):
    assert send("a.csv", b"text,form\ngo,( go )\n", as_labels="true").status_code == 403
    sent = {"text": "text,form\ngo,( go )\n", "as_labels": True}
    assert call_as(admin, "post", "worlds/home/uploads/", sent).json()["forms"] == 1
    assert tiny_world.utterances.get().logical_form == "( go )"


@pytest.mark.parametrize("texts", [JSONL.splitlines(), ["id,text", "1,go"], ["$Main = go"]])
def test_lines_of_a_file_are_refused_as_texts(call_as, tiny_world, annotator, texts):
    answer = call_as(annotator, "post", "worlds/home/utterances/", {"texts": texts})
    assert answer.json()["problems"][0]["field"] == "texts"
    assert not Utterance.objects.exists()


def test_an_utterance_is_deleted_by_its_version_and_restored(call_as, tiny_world, annotator):
    collect(tiny_world, ["go"], by=annotator)
    path = f"worlds/home/utterances/{Utterance.objects.get().pk}/"
    assert call_as(annotator, "delete", path).status_code == 428
    assert call_as(annotator, "delete", path, if_match='"7"').status_code == 412
    assert call_as(annotator, "delete", path, if_match='"1"').status_code == 204
    assert call_as(annotator, "get", path).status_code == 404
    (entry,) = call_as(annotator, "get", "worlds/home/deleted/utterance/").json()["results"]
    sent = {"entry": entry["entry"]}
    answer = call_as(annotator, "post", f"worlds/home/history/utterance/{entry['id']}/", sent)
    assert answer.json()["row"]["version"] == 2
    assert Utterance.objects.get().text == "go"


def test_an_empty_file_is_refused_with_what_to_do(send, tiny_world):
    answer = send("said.txt", b"")
    assert answer.status_code == 400
    assert "utterances" in answer.json()["detail"]
