"""Labels go out as JSON Lines, CSV and Parquet, filtered as the list is, and their texts come in again."""

from __future__ import annotations

import csv
import io
import json

import pytest

from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label
from annotations.labelling.label_export import FIELDS
from annotations.labelling.utterance_deletion import delete_utterances
from annotations.labelling.utterance_uploads import ReadingChoices, preview
from annotations.models import Origin, Utterance, Verdict, World

GO = '( go " <room> " )'
EXPORT = "worlds/home/utterances/export/"


@pytest.fixture
def said(tiny_world, annotator) -> World:
    """Three utterances: one labelled, one that a person has answered blindly, one that looks like a formula."""
    collect(tiny_world, ["go to the kitchen", "find the tea", "=1+1"], Origin.UPLOADED, annotator)
    first, second, _ = tiny_world.utterances.all()
    label(first, Verdict.FORM, GO, annotator, 1, seconds=2.5)
    label(second, Verdict.FORM, GO, annotator, 1, is_blind=True)
    return tiny_world


@pytest.fixture
def export(call_as, said, annotator):
    """A function: the bytes of an export."""

    def get(query: str) -> bytes:
        answer = call_as(annotator, "get", f"{EXPORT}?{query}")
        assert answer.status_code == 200
        return b"".join(answer.streaming_content)

    return get


def test_json_lines_say_who_labelled_what_and_when(export):
    rows = [json.loads(line) for line in export("as=jsonl").splitlines()]
    assert [tuple(row) for row in rows] == [FIELDS] * 3
    first, second, _ = rows
    assert (first["logical_form"], first["annotator"], first["seconds"]) == (GO, "anna", 2.5)
    assert (first["labels"][0]["verdict"], first["spans"]) == (
        "form",
        [[10, 17, "room", "kitchen"]],
    )
    assert (second["labels"], second["annotator"]) == ([], "")  # a blind answer is nobody's to see


def test_a_table_holds_no_formula(export):
    rows = list(csv.DictReader(io.StringIO(export("as=csv").decode(), newline="")))
    assert rows[2]["text"] == "'=1+1"
    assert json.loads(rows[0]["labels"])[0]["form"] == GO


def test_parquet_holds_the_same(export):
    import pandas

    table = pandas.read_parquet(io.BytesIO(export("as=parquet")))
    rows = [json.loads(line) for line in export("as=jsonl").splitlines()]
    assert list(table) == list(FIELDS)
    for name in FIELDS:
        cells = [
            json.dumps(row[name], ensure_ascii=False) if name in ("spans", "labels") else row[name]
            for row in rows
        ]
        assert table[name].astype(object).where(table[name].notna(), None).tolist() == cells
    assert [table[name].dtype.kind for name in ("id", "version", "seconds")] == [*"iif"]


@pytest.mark.parametrize(
    ("query", "count"), [("status=labelled", 1), ("q=tea", 1), ("origin=review", 0)]
)
def test_it_is_filtered_as_the_list_is(export, query, count):
    assert len(export(f"as=jsonl&{query}").splitlines()) == count
    assert len(export(f"as=parquet&{query}")) > 0


def test_what_is_deleted_is_left_out_and_an_unknown_format_refused(
    export, said, call_as, annotator
):
    delete_utterances([said.utterances.first().pk], annotator)
    assert len(export("as=jsonl").splitlines()) == 2
    assert call_as(annotator, "get", f"{EXPORT}?as=xlsx").status_code == 400
    assert call_as(annotator, "get", f"{EXPORT}?status=late").status_code == 400


@pytest.mark.parametrize("as_", ["jsonl", "csv"])
def test_an_export_is_an_upload_again(export, other_world, as_):
    data = export(f"as={as_}")
    shown = preview(other_world, data, f"home.{as_}", ReadingChoices(as_labels=True))
    assert shown.texts == tuple(Utterance.objects.values_list("text", flat=True))
    assert shown.forms == {"go to the kitchen": GO}
    assert shown.sheet.column == "text"


def test_the_list_offers_it(said, anna):
    page = anna.get("/w/home/utterances/?status=labelled").content.decode()
    assert "export/?as=csv&amp;status=labelled" in page


def test_the_number_of_queries_does_not_grow_with_the_list(
    said, annotator, django_assert_max_num_queries, export
):
    collect(said, [f"go {n}" for n in range(50)], by=annotator)
    with django_assert_max_num_queries(12):
        assert len(export("as=jsonl").splitlines()) == 53
