"""Utterances are pasted or uploaded, listed, and shown with every answer to them."""

from __future__ import annotations

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label
from annotations.models import JobKind, Utterance, Verdict
from annotations.web.corpus import upload_pages, utterance_pages
from tests.notices import levels

NEW = "/w/home/utterances/new/"


def test_pasted_lines_are_added_and_a_worker_is_asked(sample, anna):
    answer = anna.post(NEW, {"text": "find the tea\n\ngo home\r\n"})
    assert answer.url == "/w/home/label/"
    assert [str(row) for row in sample.world.utterances.all()] == ["find the tea", "go home"]
    assert sample.world.jobs.get().kind == JobKind.PROPOSE


def test_what_was_pasted_twice_is_said_and_stored_once(sample, anna):
    collect(sample.world, ["find the tea"])
    anna.post(NEW, {"text": "find the tea\ngo home\ngo home"})
    assert sample.world.utterances.count() == 2


def test_a_file_is_shown_before_anything_is_stored(sample, anna, rene):
    file = SimpleUploadedFile("said.txt", "find the tea\ngrüß mich\n".encode())
    address = anna.post(NEW, {"text": "", "file": file}).url
    page = anna.get(address)
    assert page.context["shown"].n_new == 2
    assert not sample.world.utterances.exists()
    assert rene.get(address).status_code == 403
    assert anna.post(address).status_code == 302
    upload = sample.world.uploads.get()
    assert sample.world.utterances.get(text="grüß mich").upload == upload
    assert len(anna.get("/w/home/utterances/uploads/").context["listing"].rows) == 1


@pytest.mark.parametrize("text", ['{"text": "go"}\n{"text": "come"}', "Nr;Command\n1;go\n2;come"])
def test_a_pasted_table_or_json_is_shown_first_and_read_otherwise_if_asked(sample, anna, text):
    address = anna.post(NEW, {"text": text}).url
    page = anna.get(address)
    assert page.context["shown"].texts == ("go", "come")
    if ";" in text:  # what was recognised is what is chosen
        assert page.context["form"]["column"].value() == "Command"
        otherwise = anna.get(f"{address}?column=Nr")
        assert otherwise.context["shown"].texts == ("1", "2")
        assert not otherwise.context["form"].errors
    assert anna.get(f"{address}?format=text").context["shown"].n_new == len(text.splitlines())
    assert anna.post(address, {"format": "text", "column": "nothing"}).status_code == 422
    assert anna.post(address, {"format": "csv" if ";" in text else "jsonl"}).status_code == 302
    assert [str(row) for row in sample.world.utterances.all()] == ["go", "come"]


def test_an_upload_is_undone_from_the_notice_and_redone(sample, anna, annotator):
    anna.post(NEW, {"text": "find the tea\ngo home"})
    upload = sample.world.uploads.get()
    here = f"/w/home/utterances/uploads/{upload.pk}"
    label(sample.world.utterances.first(), Verdict.UNKNOWN, "", annotator, 1)
    asked = anna.post(f"{here}/undo/")
    assert (asked.status_code, asked.context["n_labelled"]) == (200, 1)
    assert anna.post(f"{here}/undo/", {"labelled": "keep"}).status_code == 302
    assert sample.world.utterances.count() == 1
    anna.post(f"{here}/redo/")
    assert sample.world.utterances.count() == 2
    assert f'action="{here}/undo/"' in anna.get("/w/home/utterances/").content.decode()


def test_the_name_of_a_file_is_normalised(sample, anna):
    file = SimpleUploadedFile("cafe\u0301.txt", b"go home\n")
    anna.post(NEW, {"text": "", "file": file})
    assert sample.world.uploads.get().file_name == "caf\u00e9.txt"


def test_what_is_answered_while_an_upload_is_undone_stays(sample, anna, annotator, monkeypatch):
    anna.post(NEW, {"text": "find the tea\ngo home"})
    here = f"/w/home/utterances/uploads/{sample.world.uploads.get().pk}"
    label(sample.world.utterances.first(), Verdict.UNKNOWN, "", annotator, 1)
    monkeypatch.setattr(
        upload_pages, "count_labelled", lambda upload: 0
    )  # as it was a moment before
    assert anna.post(f"{here}/undo/").status_code == 302
    assert [str(row) for row in sample.world.utterances.all()] == ["find the tea"]


def test_an_utterance_is_deleted_listed_and_restored(sample, anna):
    collect(sample.world, ["find the tea"])
    row = sample.world.utterances.get()
    page = f"/w/home/history/utterance/{row.pk}/"
    assert anna.get(f"{page}delete/").status_code == 200
    anna.post(f"{page}delete/", {"version": row.version})
    assert anna.get(f"/w/home/utterances/{row.pk}/").status_code == 404
    assert anna.get(f"/w/home/label/?utterance={row.pk}").status_code == 404
    (entry, text) = anna.get("/w/home/history/utterance/deleted/").context["entries"][0]
    assert text == "find the tea"
    anna.post(page, {"entry": entry.history_id})
    assert sample.world.utterances.get().version == 2


def test_several_are_deleted_and_restored_together(sample, anna):
    collect(sample.world, ["find the tea", "go home", "go away"])
    first, *_ = sample.world.utterances.all()
    address = "/w/home/utterances/delete/"
    assert anna.get(f"{address}?row={first.pk}").context["total"] == 1
    assert anna.get(f"{address}?row={first.pk}x").context["total"] == 0  # and not all
    page = anna.post(f"{address}?q=go", {"total": 1})  # another number was seen
    assert page.status_code == 200 and levels(page) == ["warning"]
    assert sample.world.utterances.count() == 3
    anna.post(f"{address}?q=go", {"total": 2})
    assert [row.text for row in sample.world.utterances.all()] == ["find the tea"]
    at = Utterance.with_deleted.exclude(deleted_at=None).first().deleted_at
    anna.post("/w/home/utterances/restore/", {"at": at.isoformat()})
    assert sample.world.utterances.count() == 3


def test_more_than_can_be_deleted_at_once_are_not(sample, anna, monkeypatch):
    collect(sample.world, ["find the tea", "go home"])
    monkeypatch.setattr(utterance_pages, "MOST_DELETED", 1)
    page = anna.post("/w/home/utterances/delete/", {"total": "2"})
    assert page.context["is_too_many"]
    assert sample.world.utterances.count() == 2


def test_nothing_is_added_where_a_line_cannot_be(sample, anna):
    for text in ("fine\n" + "x" * 501, "  \n "):
        assert anna.post(NEW, {"text": text}).status_code == 422
    for data in (b"\xff\xfe\x00", b"", b"\xef\xbb\xbf \n"):
        answer = anna.post(NEW, {"file": SimpleUploadedFile("said.txt", data)})
        assert answer.status_code == 422 and "said.txt" in answer.content.decode()
    assert not sample.world.utterances.exists()


def test_a_blind_answer_is_shown_to_its_author_alone(sample, anna, rene, annotator):
    collect(sample.world, ["find the tea"])
    row = sample.world.utterances.get()
    label(row, Verdict.UNKNOWN, "", annotator, 1, is_blind=True)
    page = f"/w/home/utterances/{row.pk}/"
    assert list(rene.get(page).context["labels"]) == []
    assert len(anna.get(page).context["labels"]) == 1


def test_admins_alone_store_the_forms_of_a_file_as_labels(sample, anna, adam):
    for client, status in ((anna, "unlabelled"), (adam, "labelled")):
        address = client.post(NEW, {"text": f"text,form\ngo {status},( go )\ncome {status},"}).url
        assert ("as_labels" in client.get(address).content.decode()) == (client is adam)
        client.post(address, {"as_labels": "on"})
        assert sample.world.utterances.get(text=f"go {status}").status == status
