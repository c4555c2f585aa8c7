"""Utterances are pasted or uploaded, listed, and shown with every answer to them."""

from __future__ import annotations

from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.labelling import collect, label
from annotations.models import JobKind, Verdict

NEW = "/w/home/utterances/new/"


def test_pasted_lines_are_added_and_a_worker_is_asked(sample, anna):
    answer = anna.post(NEW, {"text": "find the tea\n\ngo home\r\n"})
    assert answer.url == "/w/home/label/"
    assert [str(row) for row in sample.world.utterances.all()] == ["find the tea", "go home"]
    assert sample.world.jobs.get().kind == JobKind.PROPOSE


def test_an_uploaded_file_is_read_and_duplicates_are_said(sample, anna):
    collect(sample.world, ["find the tea"])
    file = SimpleUploadedFile("said.txt", "find the tea\ngrüß mich\n".encode())
    page = anna.post(NEW, {"text": "", "file": file}).content.decode()
    assert "1 utterance added" in page
    assert sample.world.utterances.get(text="grüß mich").origin == "uploaded"


def test_nothing_is_added_where_a_line_cannot_be(sample, anna):
    for text in ("fine\n" + "x" * 501, "  \n "):
        assert anna.post(NEW, {"text": text}).status_code == 422
    file = SimpleUploadedFile("said.txt", b"\xff\xfe\x00")
    assert anna.post(NEW, {"file": file}).status_code == 422
    assert not sample.world.utterances.exists()


def test_a_blind_answer_is_shown_to_its_author_alone(sample, anna, rene, annotator):
    collect(sample.world, ["find the tea"])
    row = sample.world.utterances.get()
    label(row, Verdict.UNKNOWN, "", annotator, 1, is_blind=True)
    page = f"/w/home/utterances/{row.pk}/"
    assert list(rene.get(page).context["labels"]) == []
    assert len(anna.get(page).context["labels"]) == 1
