"""Results of a paraphrasing task: tables as spreadsheets and sites write them."""

from __future__ import annotations

import csv
import io

import pytest

from annotations.language.corpus import read_crowd_results

HEAD = [
    *(
        "HITId",
        "WorkerId",
        "AssignmentStatus",
        "Input.command1",
        "Input.parse1",
        "Input.parse_ground1",
    ),
    *(
        "Input.command2",
        "Input.parse_ground2",
        "Answer.utterance1",
        "Answer.utterance2",
        "Answer.comment",
    ),
]
GO, TEA = '( go " attic " )', '( bring " tea, hot " )'
ROWS = [
    [
        "H1",
        "W1",
        "Approved",
        "go up",
        "x",
        GO,
        "get tea",
        TEA,
        "Would you go up, please?",
        "NA",
        "",
    ],
    ["H1", "W2", "Rejected", "go up", "x", GO, "get tea", TEA, "asdf", "asdf", ""],
    ["H2", "W3", "Submitted", "go up", "x", GO, "get tea", TEA, "", "tea;\nnow", 'with "quotes"'],
]
EXPECTED = [
    ("Would you go up, please?", "go up", GO),
    ("NA", "get tea", TEA),
    ("tea; now", "get tea", TEA),
]


def table(rows=ROWS, delimiter=",", end="\n", head=HEAD):
    written = io.StringIO()
    csv.writer(written, delimiter=delimiter, lineterminator=end).writerows([head, *rows])
    return written.getvalue()


def answers(data):
    file = read_crowd_results(data, "results.csv")
    assert file.problems == ()
    return [(each.paraphrase, each.command, each.canonical_form) for each in file.records]


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\n\n", "\n \n"])
@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig"])
def test_separators_line_ends_marks_and_blank_lines_play_no_part(delimiter, end, codec):
    text = table(delimiter=delimiter, end=end)
    assert answers(text.encode(codec)) == EXPECTED
    assert answers((text + "\n\n").encode(codec)) == EXPECTED
    assert answers(text.rstrip().encode(codec)) == EXPECTED


def test_the_case_of_the_heads_plays_no_part():
    assert answers(table(head=[name.upper() for name in HEAD]).encode()) == EXPECTED


def test_a_form_that_cannot_be_read_and_a_row_of_another_length_have_their_lines():
    bad = [*ROWS[0][:5], "( go", *ROWS[0][6:]]
    text = table([ROWS[0], bad, ["H1", "W1"], ROWS[2]])
    file = read_crowd_results(text.encode(), "results.csv")
    assert [(each.position.line, each.is_error) for each in file.problems] == [(3, True), (4, True)]
    assert len(file.records) == 4


def test_a_table_of_another_kind_is_a_warning_and_a_broken_one_an_error():
    (problem,) = read_crowd_results(b"text,label\nhello,greet\n", "other.csv").problems
    assert not problem.is_error
    (problem,) = read_crowd_results((table() + '"H9').encode(), "results.csv").problems
    assert problem.is_error and problem.position.line > 4


def test_what_does_not_show_is_left_out_with_a_warning_for_its_line():
    rows = [
        ["H1", "W1", "Approved", "go\u200b up", "x", GO, "", "", "cafe\u0301,\xa0please", "", ""]
    ]
    file = read_crowd_results(table(rows).encode(), "results.csv")
    (answer,) = file.records
    assert (answer.command, answer.paraphrase) == ("go up", "caf\u00e9, please")
    (problem,) = file.problems
    assert problem.position.line == 2 and not problem.is_error


def test_the_line_with_which_excel_names_the_separator_is_none_of_the_table():
    head = "Input.command1;Input.parse_ground1;Answer.utterance1"
    text = f"sep=;\n{head}\ngo on;( a );walk, on\ngo on;( a;walk\n"
    read = read_crowd_results(text.encode(), "results.csv")
    assert [each.paraphrase for each in read.records] == ["walk, on"]
    assert [each.position.line for each in read.problems] == [4]


def test_a_table_of_nothing_but_its_delimiter_is_no_table_of_results():
    (problem,) = read_crowd_results(b"sep=;\n", "answers.csv").problems
    assert not problem.is_error
