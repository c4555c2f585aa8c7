"""Labels for doccano, Label Studio, CoNLL and brat: other libraries read them, and an upload takes them in again."""

from __future__ import annotations

import io
import json
import re
import zipfile
from pathlib import Path

import conllu
import pytest
from bioc import brat
from bioc.brat.validator import validate
from conllu.models import TokenList
from django.core.files.uploadedfile import SimpleUploadedFile
from hypothesis import given
from hypothesis import strategies as st

from annotations.exchange.generator_import import import_generator
from annotations.labelling.collecting import collect
from annotations.labelling.entity_spans import anonymized_by
from annotations.labelling.label_answers import label
from annotations.labelling.label_formats import LABEL_FILES, LabelFormat
from annotations.labelling.upload_reading import decode_upload, read_upload
from annotations.labelling.utterance_uploads import ReadingChoices, content_of, preview, store
from annotations.language.grounding import Anonymizer
from annotations.language.texts import normalise_line
from annotations.language.world import Entity, Ontology
from annotations.models import Upload, Utterance, Verdict

GO = '( go " <room> " )'
GUIDE = Path(__file__).parents[3] / "docs" / "guides" / "other-tools.md"
NAMED = Anonymizer(
    Ontology(
        [
            Entity("room", "living room"),
            Entity("room", "bath"),
            Entity("object", "tea", aliases=("#",)),
        ]
    )
)
WORDS = st.one_of(
    st.sampled_from(
        ["living room", "Tea", "bath,", "#", "-", "Anna's", "1", "_", "form=(go)", "❤", "B-room"]
    ),
    st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=6),
)
TEXTS = st.lists(WORDS, min_size=1, max_size=6).map(" ".join).map(normalise_line).filter(bool)
ROWS = st.lists(st.tuples(TEXTS, st.sampled_from(["", GO, "( stop )"])), min_size=1, max_size=6)


def utterances(rows: list[tuple[str, str]]) -> list[Utterance]:
    return [
        Utterance(pk=n, text=text, logical_form=form, **anonymized_by(NAMED, text))
        for n, (text, form) in enumerate(rows, start=1)
    ]


def written(rows: list[Utterance], as_: LabelFormat) -> bytes:
    return b"".join(LABEL_FILES[as_].write(rows, ["room", "object"]))


def entities(row: Utterance) -> list[tuple[str, str]]:
    return [(token, row.text[start:end]) for start, end, token, _ in row.spans]


@pytest.mark.parametrize("as_", LabelFormat)
@given(rows=ROWS)
def test_texts_and_forms_come_back(as_, rows):
    name = f"said.{LABEL_FILES[as_].suffix}"
    data = content_of(SimpleUploadedFile(name, written(utterances(rows), as_)))
    sheet = read_upload(decode_upload(data, name)[0], name)
    read = [
        (each.values[sheet.column], each.values.get(sheet.form_column, ""))
        for each in sheet.records
    ]
    assert (read, sheet.problems) == (rows, ())


@given(rows=ROWS)
def test_doccano_finds_the_entities_at_their_characters(rows):
    lines = written(said := utterances(rows), LabelFormat.DOCCANO).decode().split("\n")[:-1]
    for row, line in zip(said, map(json.loads, lines), strict=True):
        found = [(token, line["text"][start:end]) for start, end, token in line["label"]]
        assert found == entities(row)


@given(rows=ROWS)
def test_label_studio_has_annotations_where_there_is_a_form(rows):
    tasks = json.loads(written(said := utterances(rows), LabelFormat.LABEL_STUDIO))
    for row, task in zip(said, tasks, strict=True):
        ((kind, (work,)),) = [(name, task[name]) for name in task if name != "data"]
        assert kind == ("annotations" if row.logical_form else "predictions")
        spans = [each["value"] for each in work["result"] if each["type"] == "labels"]
        assert [(each["labels"][0], each["text"]) for each in spans] == entities(row)
        assert all(task["data"]["text"][s["start"] : s["end"]] == s["text"] for s in spans)


def test_label_studio_takes_the_tasks_and_its_exports_come_back(tmp_path):
    sdk = "label_studio_sdk"
    interface = pytest.importorskip(f"{sdk}.label_interface", reason=f"needs the package {sdk}")
    converter = pytest.importorskip(f"{sdk}.converter", reason=f"needs the package {sdk}")
    (config,) = re.findall(r"<View>.*</View>", GUIDE.read_text("utf-8"), re.DOTALL)
    rows = utterances([("go to the bath, please", GO), ("tea", "")])
    tasks = json.loads(written(rows, LabelFormat.LABEL_STUDIO))
    checks = interface.LabelInterface(config)
    checks.validate()
    assert all(checks.validate_task({"data": task["data"]}) for task in tasks)
    assert all(map(checks.validate_annotation, tasks[0]["annotations"]))
    assert all(map(checks.validate_prediction, tasks[1]["predictions"]))
    annotated = {**tasks[0], "id": 1}
    annotated["annotations"][0] |= {"id": 1, "completed_by": 1}
    (tmp_path / "tasks.json").write_text(json.dumps([annotated]))
    exporter = converter.Converter(config, None)
    exporter.convert(str(tmp_path / "tasks.json"), str(tmp_path), "JSON_MIN", is_dir=False)
    exporter.convert(str(tmp_path / "tasks.json"), str(tmp_path), "CONLL2003", is_dir=False)
    sheet = read_upload((tmp_path / "result.json").read_text("utf-8"))
    (row,) = sheet.records
    assert (row.values[sheet.column], row.values[sheet.form_column]) == (rows[0].text, GO)
    words = (tmp_path / "result.conll").read_text("utf-8")
    assert [row.values["text"] for row in read_upload(words).records] == ["go to the bath , please"]


@given(rows=ROWS)
def test_a_library_of_conll_reads_the_tokens_and_their_tags(rows):
    text = written(said := utterances(rows), LabelFormat.CONLL).decode()
    sentences = conllu.parse(text)
    for row, sentence in zip(said, sentences, strict=True):
        assert sentence.metadata.get("text") == row.text
        assert sentence.metadata.get("logical_form", "") == row.logical_form
        assert [token["id"] for token in sentence] == list(range(1, len(sentence) + 1))
        assert "".join(token["form"] for token in sentence) == row.text.replace(" ", "")
        assert tagged(sentence) == [
            (token, words.replace(" ", "")) for token, words in entities(row)
        ]


def tagged(sentence: TokenList) -> list[tuple[str, str]]:
    found: list[tuple[str, str]] = []
    for token in sentence:
        position, _, kind = token["ner"].partition("-")
        if position == "B":
            found.append((kind, token["form"]))
        elif position == "I":
            found[-1] = kind, found[-1][1] + token["form"]
    return found


@given(rows=ROWS)
def test_a_library_of_brat_finds_the_annotations_in_the_text(rows):
    data = written(said := utterances(rows), LabelFormat.BRAT)
    archive = zipfile.ZipFile(io.BytesIO(data))
    text, annotations, kinds = (
        archive.read(name).decode()
        for name in ("utterances.txt", "utterances.ann", "annotation.conf")
    )
    document = brat.loads(text, annotations)
    validate(document)  # raises where an annotation has another text than its place
    spans = [(each.type, each.text) for each in document.entities]
    assert spans == [pair for row in said for pair in [("Utterance", row.text), *entities(row)]]
    forms = [(document.get_annotation(each.refid).text, each.text) for each in document.notes]
    assert forms == [(row.text, row.logical_form) for row in said if row.logical_form]
    assert {"room", "object", "Utterance"} < set(kinds.split())


@pytest.mark.parametrize("as_", LabelFormat)
def test_a_world_of_the_same_names_gets_the_same_utterances(
    as_, tiny_world, other_world, tiny, admin, annotator, call_as
):
    import_generator(other_world.name, tiny)
    collect(tiny_world, ["go to the bath", "find the tea, please"], by=annotator)
    label(tiny_world.utterances.first(), Verdict.FORM, GO, annotator, 1)
    answer = call_as(annotator, "get", f"worlds/home/utterances/export/?as={as_}")
    name = answer["Content-Disposition"].split('"')[1]
    file = SimpleUploadedFile(name, b"".join(answer.streaming_content))
    shown = preview(other_world, content_of(file), name, ReadingChoices(as_labels=True))
    store(other_world, shown, Upload(file_name=name), admin)
    columns = ("text", "anonymized_text", "spans", "status", "logical_form")
    assert list(other_world.utterances.values_list(*columns)) == list(
        tiny_world.utterances.values_list(*columns)
    )


def test_a_form_that_somebody_changed_in_label_studio_counts():
    def annotation(form: str, **more: bool) -> dict[str, object]:
        result = {"from_name": "logical_form", "type": "textarea", "value": {"text": [form]}}
        return {"result": [{"type": "labels", "value": {}}, result], **more}

    annotations = [annotation("( old )"), annotation(GO), annotation("( no )", was_cancelled=True)]
    tasks = [{"id": 7, "data": {"text": "go home"}, "annotations": annotations}]
    sheet = read_upload(json.dumps(tasks))
    assert [row.values[sheet.form_column] for row in sheet.records] == [GO]
    assert [row.values[sheet.column] for row in sheet.records] == ["go home"]


@pytest.mark.parametrize(
    "odd", [None, 3, [], ["x"], [{}], [{"result": 3}], [{"result": [3, None]}]]
)
def test_annotations_of_another_shape_have_no_form(odd):
    sheet = read_upload(json.dumps([{"data": {"text": "go home"}, "annotations": odd}]))
    assert (sheet.form_column, sheet.problems) == ("", ())


def test_a_collection_of_brat_by_somebody_else_gives_its_lines():
    files = {
        "a/one.txt": "Bring me the cup.\n\nGo home.\n",
        "a/one.ann": "T1\tCup 13 16\tcup\nT2\tWhole 19 27\tGo home.\n#1\tAnnotatorNotes T2\t( go )\n"
        "#2\tAnnotatorNotes T9\t( lost )\nE1\tMove:T2\nR1\tIn Arg1:T1 Arg2:T2\n",
        "a/two.txt": "Stop.",
        "a/two.ann": "",
        "README.txt": "not annotated",
    }
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for path, text in files.items():
            archive.writestr(path, text)
    data = content_of(SimpleUploadedFile("brat.zip", packed.getvalue()))
    sheet = read_upload(data.decode())
    assert [(row.values["text"], row.values.get("form", "")) for row in sheet.records] == [
        ("Bring me the cup.", ""),
        ("Go home.", "( go )"),
        ("Stop.", ""),
    ]
