"""An upload is looked at before it is stored, and undone and redone as a whole."""

from __future__ import annotations

import json

import pytest

from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label
from annotations.labelling.utterance_uploads import (
    NotNow,
    ReadingChoices,
    count_labelled,
    keep_waiting,
    preview,
    redo,
    store,
    structure_of,
    undo,
)
from annotations.language.texts.errors import LanguageError
from annotations.models import Label, Upload, Utterance, Verdict
from tests.write_transactions import LONGEST, measured_transactions

GO = '( go " <room> " )'
FILE = b'text,logical_form\ngo to the kitchen,"( go "" <room> "" )"\nfind the tea,nonsense (\ngo home,\n'


@pytest.fixture
def stored(tiny_world, annotator) -> Upload:
    upload = keep_waiting(tiny_world, FILE, "said.csv", annotator)
    assert store(tiny_world, preview(tiny_world, FILE, "said.csv"), upload, annotator).added == 3
    return upload


def test_a_preview_counts_and_stores_nothing(tiny_world):
    collect(tiny_world, ["go home"])
    said = ["go  home", "", "x" * 501, "find it", "find it", *(f"go {n}" for n in range(20))]
    shown = preview(tiny_world, "\n".join(said).encode(), "said.txt")
    assert (shown.n_new, shown.n_known, shown.n_repeated, shown.n_problems) == (21, 1, 1, 1)
    assert [each.state for each in shown.first[:3]] == ["known", "new", "repeated"]
    assert len(shown.first) == 10
    assert shown.problems[0].position.line == 3
    assert tiny_world.utterances.count() == 1
    assert not tiny_world.uploads.exists()


def test_empty_cells_are_counted(tiny_world):
    shown = preview(tiny_world, b"id;text\n1;go\n2;\n", "")
    assert (shown.n_new, shown.n_empty) == (1, 1)


def test_another_column_can_be_chosen(tiny_world):
    data = b"id;command;said\n1;go;go home\n"
    assert preview(tiny_world, data, "").texts == ("go",)
    assert preview(tiny_world, data, "", ReadingChoices(column="said")).texts == ("go home",)
    with pytest.raises(LanguageError):
        preview(tiny_world, data, "", ReadingChoices(column="nothing"))


def test_lines_can_be_kept_as_they_are(tiny_world):
    data = b'{"text": "go"}\n{"text": "come"}'
    assert preview(tiny_world, data, "", ReadingChoices(format="text")).n_new == 2
    assert preview(tiny_world, data, "").texts == ("go", "come")


def test_an_upload_says_who_sent_what(stored, annotator):
    stored.refresh_from_db()
    assert (stored.file_name, stored.added, stored.created_by) == ("said.csv", 3, annotator)
    assert (stored.format, stored.column, bytes(stored.content)) == ("csv", "text", b"")
    assert stored.utterances.count() == 3
    assert {row.origin for row in stored.utterances.all()} == {"uploaded"}


def test_it_is_undone_and_redone_as_a_whole(stored, tiny_world, annotator, reviewer):
    collect(tiny_world, ["find me"])
    assert undo(stored, reviewer, with_labelled=True) == 3
    assert [row.text for row in tiny_world.utterances.all()] == ["find me"]
    with pytest.raises(NotNow):
        undo(stored, reviewer, with_labelled=True)
    collect(tiny_world, ["go home"])
    assert redo(stored, annotator) == (2, 1)
    assert tiny_world.utterances.count() == 4
    with pytest.raises(NotNow):
        redo(stored, annotator)


def test_what_somebody_has_answered_since_is_counted_and_kept(stored, annotator):
    row = stored.utterances.first()
    label(row, Verdict.UNKNOWN, "", annotator, 1)
    assert count_labelled(stored) == 1
    assert undo(stored, annotator, with_labelled=False) == 2
    assert [each.pk for each in stored.utterances.all()] == [row.pk]


def test_answers_come_back_with_it(stored, annotator):
    label(stored.utterances.first(), Verdict.UNKNOWN, "", annotator, 1)
    undo(stored, annotator, with_labelled=True)
    redo(stored, annotator)
    assert stored.utterances.filter(status="unknown").count() == 1


def test_forms_become_labels_only_where_it_is_said(tiny_world, admin):
    shown = preview(tiny_world, FILE, "", ReadingChoices(as_labels=True))
    assert (dict(shown.forms), shown.n_bad_forms) == ({"go to the kitchen": GO}, 1)
    upload = Upload()
    store(tiny_world, shown, upload, admin)
    row = Utterance.objects.get(status="labelled")
    assert (row.logical_form, row.accepted_label.annotator) == (GO, admin)
    assert Label.objects.count() == 1
    assert count_labelled(upload) == 0
    assert not preview(tiny_world, FILE, "").forms


def test_an_upload_that_is_sent_twice_is_stored_once(tiny_world, admin):
    upload = keep_waiting(tiny_world, FILE, "said.csv", admin)
    again = Upload.objects.get(pk=upload.pk)
    store(tiny_world, preview(tiny_world, FILE, "", ReadingChoices(as_labels=True)), upload, admin)
    lines = preview(tiny_world, FILE, "", ReadingChoices(format="text"))
    assert store(tiny_world, lines, again, admin).added == 0
    upload.refresh_from_db()
    assert (upload.added, upload.format, upload.utterances.count()) == (3, "csv", 3)
    assert Label.objects.count() == 1


def test_one_person_has_one_upload_waiting(tiny_world, annotator, admin):
    for by in (annotator, annotator, admin):
        keep_waiting(tiny_world, b"go", "a.txt", by)
    assert tiny_world.uploads.waiting().count() == 2


@pytest.mark.parametrize(
    "texts",
    [
        [json.dumps({"text": "go"}), json.dumps({"text": "come"})],
        ['{"text": "go"}'],
        ["Nr;Command", '1;"go home"'],
        ["id,text", "1,go"],
        ["go", "( go )", "come", "( come )"],
    ],
)
def test_the_lines_of_a_file_are_no_texts(texts):
    assert structure_of(texts)


@pytest.mark.parametrize(
    "texts", [["go"], ["go, please"], ["go, a", "come, b"], ["1", "2"], [], [""]]
)
def test_what_people_say_has_no_structure(texts):
    assert not structure_of(texts)


def test_invisible_characters_are_counted_and_gone(tiny_world):
    shown = preview(tiny_world, "go\u200b home\ngo home\n\u200b\nfind\u00a0it".encode(), "")
    assert (shown.texts, shown.n_cleaned, shown.n_repeated) == (("go home", "find it"), 1, 1)
    assert shown.n_empty == 1


def test_an_upload_of_many_holds_nobody_up(tiny_world, annotator):
    data = "\n".join(f"go to the kitchen {n}" for n in range(5_000)).encode()
    with measured_transactions(LONGEST) as lasted:
        upload = Upload()
        store(tiny_world, preview(tiny_world, data, ""), upload, annotator)
        undo(upload, annotator, with_labelled=True)
        redo(upload, annotator)
    assert not lasted
    assert tiny_world.utterances.count() == 5_000
