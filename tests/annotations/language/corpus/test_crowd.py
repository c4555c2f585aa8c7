"""Results of a paraphrasing task: tables as spreadsheets and markets write them."""

from __future__ import annotations

import csv
import io

import pytest

from annotations.language.corpus import crowd, read_crowd_results

HEAD = [
    *("HITId", "WorkerId", "AssignmentStatus", "WorkTimeInSeconds"),
    *("Input.command1", "Input.parse1", "Input.parse_ground1"),
    *("Input.command2", "Input.parse_ground2"),
    *("Answer.utterance1", "Answer.utterance2", "Answer.custom1", "Answer.comment"),
]
GO, TEA = '( go " attic " )', '( bring " tea, hot " )'
UP = '( go " <room> " )'
PROMPTS = ["go up", '( go "  <room> " )', GO, "get tea", TEA]
ROWS = [
    ["H1", "W1", "Approved", "70", *PROMPTS, "Would you go up, please?", "NA", "", ""],
    ["H1", "W2", "Rejected", "3", *PROMPTS, "asdf", "asdf", "", ""],
    ["H2", "W3", "Submitted", "", *PROMPTS, "", "tea;\nnow", "dance", 'with "quotes"'],
    ["H3", "W4", "Approved", "9", *PROMPTS, "", "", "", ""],
]
EXPECTED = [
    ("W1", 70.0, [("go up", UP, GO, "Would you go up, please?"), ("get tea", "", TEA, "NA")], ()),
    ("W3", None, [("get tea", "", TEA, "tea; now")], ("dance",)),
]  # fmt: skip


def table(rows=ROWS, delimiter=",", end="\n", head=HEAD) -> str:
    written = io.StringIO()
    csv.writer(written, delimiter=delimiter, lineterminator=end).writerows([head, *rows])
    return written.getvalue()


def read(text, longest=500):
    return read_crowd_results(text, "results.csv", longest)


def answers(text):
    return [
        (
            each.worker,
            each.seconds,
            [(row.command, row.form, row.grounded_form, row.text) for row in each.rewrites],
            each.free_commands,
        )
        for each in read(text).assignments
    ]


def places(text, **options):
    return [
        (each.position.line, each.position.column, each.is_error)
        for each in read(text, **options).problems
    ]


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("end", ["\n", "\n\n", "\n \n"])
def test_separators_and_blank_lines_play_no_part(delimiter, end):
    text = table(delimiter=delimiter, end=end)
    assert answers(text) == answers(text + "\n\n") == answers(text.rstrip()) == EXPECTED


def test_the_case_of_the_heads_plays_no_part():
    assert answers(table(head=[name.upper() for name in HEAD])) == EXPECTED


def test_what_is_left_out_is_counted():
    results = read(table())
    assert (results.rejected, results.empty, results.comments) == (1, 1, 1)
    assert [each.line for each in results.assignments] == [2, 4]


def test_nobody_sees_the_id_of_a_worker_by_accident():
    assert "W1" not in repr(read(table()))


def test_a_link_and_a_table_call_a_worker_by_one_name():
    by_mturk, by_prolific = (
        read(table(head=[name if name != "WorkerId" else each for name in HEAD]))
        for each in ("workerid", "PROLIFIC_PID")
    )
    assert by_mturk.assignments[0].market == "workerId"
    assert by_prolific.assignments[0].market == "PROLIFIC_PID"


def test_the_apostrophe_of_an_export_is_none_of_the_text():
    rows = [
        ["H1", "W1", "", "", "'-- go up", "", GO, "get tea", TEA, "'=go on", "'tis tea", "", ""]
    ]
    (assignment,) = read(table(rows)).assignments
    assert [(each.command, each.text) for each in assignment.rewrites] == [
        ("-- go up", "=go on"),
        ("get tea", "'tis tea"),
    ]


def test_what_is_wrong_with_a_row_has_its_line_and_its_cell():
    good = ROWS[0]
    rows = [
        good,
        [*good[:6], "( go", *good[7:]],  # a form that cannot be read
        ["H1", "W1"],  # too short
        [good[0], " ", *good[2:]],  # of nobody
        [*good[:4], "", *good[5:]],  # an answer to nothing
        [*good[:3], "soon", *good[4:]],
        [*good[:9], "x" * 21, *good[10:]],
    ]
    text = table(rows)
    assert places(text, longest=30) == [
        (3, 7, True),
        (4, 1, True),
        (5, 2, True),
        (6, 5, True),
        (7, 4, False),
    ]
    assert (8, 10, False) in places(text, longest=20)
    assert read(text).assignments[-2].seconds is None


@pytest.mark.parametrize(
    "text",
    [
        "",
        "sep=;\n",
        "text,label\nhello,greet\n",
        "Answer.utterance1,Input.command1\na,b\n",
        "WorkerId,Answer.utterance1\nw,b\n",
        "WorkerId,workerid,Answer.custom1\nw,w,b\n",
        table() + '"H9',
        ",".join(["WorkerId", *(f"Answer.custom{number}" for number in range(21))]),
        ",".join(["WorkerId", "Answer.custom1", *(f"x{number}" for number in range(3_000))]),
    ],
)
def test_a_table_of_another_kind_or_a_broken_one_is_an_error(text):
    (problem,) = read(text).problems
    assert problem.is_error


def test_a_table_is_bounded(monkeypatch):
    monkeypatch.setattr(crowd, "MOST_ASSIGNMENTS", 1)
    assert places(table()) == [(4, 1, True)]


def test_what_does_not_show_is_left_out():
    rows = [
        ["H1", "W1", "", "", "go\u200b up", "", GO, "", "", "cafe\u0301,\xa0please", "", "", ""]
    ]
    (assignment,) = read(table(rows)).assignments
    assert [(each.command, each.text) for each in assignment.rewrites] == [
        ("go up", "caf\u00e9, please")
    ]


def test_the_line_with_which_excel_names_the_separator_is_none_of_the_table():
    head = "WorkerId;Input.command1;Input.parse_ground1;Answer.utterance1"
    text = f"sep=;\n{head}\nw;go on;( a );walk, on\nw;go on;( a;walk\n"
    assert read(text).assignments[0].rewrites[0].text == "walk, on"
    assert places(text) == [(4, 3, True)]


@pytest.mark.parametrize(
    "state", ["Returned", "RETURNED", "TIMED-OUT", "Timed Out", "timed_out", "Abandoned", "expired"]
)
@pytest.mark.parametrize("head", ["AssignmentStatus", "Status"])
def test_what_was_given_back_is_no_answer(state, head):
    names = [head if name == "AssignmentStatus" else name for name in HEAD]
    rows = [[state if cell == "Approved" else cell for cell in row] for row in ROWS]
    results = read(table(rows, head=names))
    assert [each.worker for each in results.assignments] == ["W3"]
    assert (results.unfinished, results.rejected, results.empty) == (2, 1, 0)


@pytest.mark.parametrize("state", ["AWAITING REVIEW", "Approved", "Submitted", "IP Address", ""])
def test_what_was_handed_in_is_an_answer(state):
    rows = [[state if cell == "Approved" else cell for cell in row] for row in ROWS]
    assert len(read(table(rows)).assignments) == 2


@pytest.mark.parametrize("name", ["AssignmentId", "Submission id", "SESSION_ID"])
def test_the_id_of_the_assignment_is_read(name):
    rows = [[f"A{number}", *row] for number, row in enumerate(ROWS)]
    assignments = read(table(rows, head=[name, *HEAD])).assignments
    assert [each.key for each in assignments] == ["A0", "A2"]


def test_the_id_of_somebody_is_read_under_the_name_that_the_campaign_has():
    text = table(head=["rid" if name == "WorkerId" else name for name in HEAD])
    assert read(text).problems[0].is_error
    results = read_crowd_results(text, "results.csv", 500, "RID")
    assert (results.assignments[0].market, results.assignments[0].worker) == ("RID", "W1")
    participants = table(head=["Participant id" if name == "WorkerId" else name for name in HEAD])
    assert read(participants).assignments[0].market == "PROLIFIC_PID"
