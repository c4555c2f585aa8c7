"""What people upload is read as what it is: JSON Lines, JSON, tables, pairs, plain text."""

from __future__ import annotations

import json
import sys
from contextlib import suppress

import pytest

from annotations.labelling.upload_reading import UploadFormat, decode_upload, read_upload
from annotations.language.texts.errors import LanguageError
from tests.timing import least_seconds

SAID = ["bring me the plum", "go to the study"]


def texts_of(sheet) -> list[str]:
    return [record.values[sheet.column] for record in sheet.records]


def table(delimiter: str, head: bool = True, quote: str = "") -> str:
    rows = [["Nr", "Command"], *([str(n), text] for n, text in enumerate(SAID))]
    lines = [delimiter.join(f"{quote}{cell}{quote}" for cell in row) for row in rows]
    return "\n".join(lines if head else lines[1:]) + "\n"


@pytest.mark.parametrize(
    ("text", "format", "column"),
    [
        (
            "\n".join(json.dumps({"id": 7, "text": each, "label": []}) for each in SAID),
            "jsonl",
            "text",
        ),
        (
            "\n".join(
                json.dumps({"id": 7, "data": each, "entities": [[0, 5, "x"]]}) for each in SAID
            ),
            "jsonl",
            "data",
        ),
        ("\n".join(json.dumps(each) for each in SAID), "jsonl", "text"),
        (json.dumps(SAID, indent=1), "json", "text"),
        (json.dumps([{"id": 1, "data": {"text": each}} for each in SAID]), "json", "data.text"),
        (json.dumps([{"sentence": each} for each in SAID], indent=2), "json", "sentence"),
        (json.dumps({"utterances": SAID}), "json", "text"),
        (
            json.dumps({"rasa_nlu_data": {"common_examples": [{"text": each} for each in SAID]}}),
            "json",
            "text",
        ),
        (table(","), "csv", "Command"),
        (table(";"), "csv", "Command"),
        (table("\t"), "tsv", "Command"),
        (table("|"), "csv", "Command"),
        (table(";", quote='"'), "csv", "Command"),
        (table(";", head=False), "csv", "column 2"),
        (f"sep=;\n{table(';')}", "csv", "Command"),
        ("text\nbring me the plum\ngo to the study\n", "csv", "text"),
        (
            "| Nr | text |\n| --- | --- |\n| 1 | bring me the plum |\n| 2 | go to the study |",
            "csv",
            "text",
        ),
        ("\n".join(SAID), "text", "text"),
        (f"\n{SAID[0]}\n\n{SAID[1]}\n\n", "text", "text"),
        (f"{SAID[0]}\n( go )\n{SAID[1]}\n( go )\n\n", "pairs", "utterance"),
        (f"{SAID[0]}\nbring it\n( go )\n{SAID[1]}\ngo there\n( go )\n", "pairs", "utterance"),
    ],
)
def test_each_format_is_recognised(text, format, column):
    sheet = read_upload(text)
    assert (sheet.format, sheet.column) == (format, column)
    assert [text.strip() for text in texts_of(sheet)] == SAID
    assert not sheet.problems


def test_sentences_with_commas_are_no_table():
    said = "go home, please\nbring me tea, please\nfind it, please"
    assert read_upload(said).format == UploadFormat.TEXT
    assert read_upload("<name> goes to the <room>\n<object>").format == UploadFormat.TEXT


def test_a_cell_may_have_lines_quotes_and_delimiters():
    sheet = read_upload('Nr;text\n1;"go; to\nthe ""study"""\n2;home\n')
    assert texts_of(sheet) == ['go; to\nthe "study"', "home"]
    assert [record.line for record in sheet.records] == [2, 4]


def test_what_an_export_made_safe_for_spreadsheets_is_itself_again():
    assert texts_of(read_upload("text,status\n'=1+1,x\n'tis,y\n")) == ["=1+1", "'tis"]


def test_results_of_a_crowd_belong_to_campaigns():
    text = "HITId;WorkerId;Input.command1;Answer.utterance1\nH1;W1;go;Head there\n"
    with pytest.raises(LanguageError) as refused:
        read_upload(text)
    assert "Campaigns" in refused.value.hint
    assert texts_of(read_upload(text, format="csv").with_column("Answer.utterance1"))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('{"text": "a"}\n{"text":\n{"text": "c"}', 2),
        ('[{"text": "a"},\n{"text": ]', 2),
        ('text,label\n"go to,x\nbring,y\n', 2),
        ("text,label\ngo,x\ngo, please,y\n", 3),
        ('{"text": "a"}\n12\n', 2),
        ("go\n( go )\nbring\n( go )\nfind\n", 5),
    ],
)
def test_what_cannot_be_read_is_named_with_its_line(text, line):
    (problem,) = read_upload(text, "said.csv", format=None or _format_of(text)).problems
    assert problem.position.line == line


def _format_of(text: str) -> str:
    return "pairs" if "( go )" in text else ""


@pytest.mark.parametrize(
    "text",
    [
        "$Main = go to the {room}\n$vb = find | locate",
        "go to {room} = (go (λ$1:e (is_a $1 {room})))",
        '<?xml version="1.0"?>\n<rooms><room name="x"/></rooms>',
        "<names>\n<name>Ada</name>\n</names>",
        "<!DOCTYPE html><html><p>go</p></html>",
    ],
)
def test_the_files_of_a_generator_are_no_utterances(text):
    with pytest.raises(LanguageError):
        read_upload(text)


@pytest.mark.parametrize(
    "data",
    [
        b"PK\x03\x04xlsx",
        b"%PDF-1.7",
        b"\x1f\x8bgz",
        b"PAR1",
        b"a\0b\0\0",
        b"",
        b" \n",
        b"\xef\xbb\xbf",
    ],
)
def test_what_is_no_text_is_refused_with_what_to_do(data):
    with pytest.raises(LanguageError) as raised:
        decode_upload(data, "said.xlsx")
    assert raised.value.hint


@pytest.mark.parametrize(
    ("codec", "encoding"),
    [
        ("utf-8", "utf-8"),
        ("utf-8-sig", "utf-8"),
        ("utf-16", "utf-16"),
        ("utf-16-le", "utf-16"),
        ("utf-16-be", "utf-16"),
        ("cp1252", "windows-1252"),
    ],
)
def test_encodings_are_recognised(codec, encoding):
    text = "geh ins Büro und öffne die Tür\nhole das Glas\n"
    assert decode_upload(text.encode(codec), "said.txt") == (text, encoding)


@pytest.mark.parametrize("before", ["", "a"])
@pytest.mark.parametrize(
    ("codec", "text"),
    [
        ("shift_jis", "台所へ行ってください"),
        ("gb18030", "请去厨房拿一个杯子"),
        ("euc-kr", "부엌으로 가 주세요"),
    ],
)
def test_encodings_are_recognised_wherever_a_sample_ends(codec, text, before):
    assert decode_upload((before + f"{text}\n" * 8_000).encode(codec), "said.txt")[1] == codec


def test_a_named_encoding_is_used_and_refused_where_it_does_not_fit():
    assert decode_upload("Łódź".encode("cp1250"), "x", "windows-1250")[0] == "Łódź"
    with pytest.raises(LanguageError) as raised:
        decode_upload("a\nä".encode("cp1252"), "x", "utf-8")
    assert raised.value.line == 2


def test_json_that_no_reader_survives_is_a_problem():
    for text in (
        "[" * 100_000,
        '{"a":' * 100_000,
        f"[{'9' * 50_000}]",
        '{"text": "\\ud83d"}\n{"text": "x"}',
    ):
        sheet = read_upload(text)
        assert sheet.problems or all("\ud83d" not in text for text in texts_of(sheet))


@pytest.mark.parametrize(
    "piece", ['"', ",", ";\n", "| ", "= (", "[{", " ", "'", '{"a":"b"}\n', "a,b\n", "(\n"]
)
def test_reading_takes_time_in_proportion_to_the_length(piece):
    def seconds(n: int) -> float:
        def read() -> None:
            with suppress(LanguageError):
                read_upload(piece * n)

        return least_seconds(read, times=3)

    assert seconds(80_000) < 20 * max(seconds(10_000), 0.01)


@pytest.mark.parametrize(
    "text",
    [
        "bring the apple,please\ngo home,now\n",
        "take 1,000 plums\ntake 2,000 plums\n",
        "Message, please read it\nsay hello, robot\n",
        "text, please\nbring me the plum, please\n",
        '"bring me the plum", she said\n"go home", he said\n',
        "the plum,the pear and the apple,please\ngo home,now,ok\n",
        "[1] bring me the plum\n[2] go home\n",
        "[um] bring me the plum\n{object} please\n",
        'say {"text": 1}\n{"text": 2} is what I said, isn\'t it\n',
    ],
)
def test_plain_text_is_no_table_and_no_json(text):
    sheet = read_upload(text)
    assert sheet.format == UploadFormat.TEXT
    assert texts_of(sheet) == text.splitlines()


@pytest.mark.parametrize("quote", ["", '"'])
def test_a_table_of_one_column_has_texts_with_commas(quote):
    texts = ["bring me the apple, please", "go home"]
    lines = [f"{quote}{each}{quote}" for each in ("Text", *texts)]
    assert texts_of(read_upload("\n".join(lines))) == texts


@pytest.mark.parametrize(
    "text",
    [
        "id, text\n1, go home\n2, come back\n",
        "id, label, text\n1, x, go home\n2, y, come back\n",
        "motion,go home\nmotion,come back\n",
        "1,go home\n2,come back\n",
        'x,"go home"\ny,"come back"\n',
        "te\u00adxt,\u200bid\ngo home,a\ncome back,b\n",
    ],
)
def test_a_table_with_commas_is_one(text):
    sheet = read_upload(text)
    assert sheet.format == UploadFormat.CSV
    assert [each.strip() for each in texts_of(sheet)] == ["go home", "come back"]


@pytest.mark.parametrize(
    "item",
    [
        {"id": 1, "text": "go home", "label": []},
        {"id": 1, "text": "go home", "label": ["motion"]},
        {"id": 1, "text": "go home", "label": [[0, 2, "verb"]]},
        {"id": 1, "text": "go home", "entities": [{"label": "verb", "start_offset": 0}]},
        {"id": 1, "data": {"text": "go home"}, "annotations": [{"result": []}]},
        {"message": "ok", "results": [{"text": "go home"}]},
        {"errors": [], "rows": {"lost": [], "found": [{"text": "go home"}]}},
    ],
)
def test_an_export_of_one_item_has_its_text(item):
    assert texts_of(read_upload(json.dumps(item))) == ["go home"]


def test_an_empty_column_of_texts_is_still_the_one():
    assert read_upload("id,text\n1,\n2,\n").column == "text"


def test_half_a_character_in_json_is_a_problem_of_its_row():
    sheet = read_upload('{"text": "go \\ud83d"}\n{"text": "go home"}\n')
    assert texts_of(sheet) == ["go home"]
    assert [each.position.line for each in sheet.problems] == [1]
    sheet = read_upload('["go \\ud83d"]\n["go home"]\n')
    assert texts_of(sheet) == ["go home"]


def test_json_of_any_depth_is_read_or_is_a_problem():
    for depth in range(5, sys.getrecursionlimit(), 5):
        for begin, end in (('{"a":', "}"), ("[", "]")):
            for text in (
                begin * depth + '"go"' + end * depth,
                f"{begin * depth}1{end * depth}\n12",
            ):
                sheet = read_upload(text)
                assert sheet.problems or sheet.columns


def test_the_names_of_json_are_normalised_like_what_is_chosen():
    sheet = read_upload('{"re\\u0301ponse": "go", "x": "1"}\n{"re\\u0301ponse": "come", "x": "2"}')
    assert sheet.with_column("r\u00e9ponse").column == "r\u00e9ponse"


def test_columns_of_few_rows_cost_the_others_nothing():
    def seconds(n_columns: int) -> float:
        names = ",".join(f'"{number}":""' for number in range(n_columns))
        return least_seconds(lambda: read_upload("{" + names + "}\n" + "{}\n" * 100_000), times=3)

    assert seconds(200) < 2.5 * seconds(1)


def test_a_cell_that_is_too_long_is_named_as_such():
    (problem,) = read_upload(f'text,label\n"{"a" * 140_000}",x\n').problems
    assert "more than" in problem.message
    assert problem.position.line == 2


def test_a_quotation_mark_is_no_delimiter():
    assert read_upload('sep="\ngo to "the" study\n').format == UploadFormat.TEXT
