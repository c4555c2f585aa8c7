from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import (
    CORPUS_FOLDERS,
    PART_FILES,
    by_length,
    read_pairs,
    read_triples,
    write_pairs,
)
from annotations.language.forms import Form, canonical_text, to_corpus
from annotations.language.texts.errors import Position
from tests.annotations.language.published import SHARED, needs_corpus
from tests.annotations.language.random_forms import forms

FILE = 'go to the attic\n( go " <room> " )\ngo ,  please \n(go "kitchen")\n'
PUBLISHED = {
    ("gen", "train"): (847, None),
    ("gen", "validation"): (121, None),
    ("gen", "test"): (243, None),
    ("gen_logical", "test"): (232, 21),
    ("para", "test"): (362, None),
    ("para_logical", "test"): (335, 21),
    ("gen_logical", "train"): (850, 68),
    ("gen_logical", "validation"): (129, 12),
    ("para", "train"): (1265, 100),
    ("para", "validation"): (181, None),
    ("para_logical", "train"): (1244, 66),
    ("para_logical", "validation"): (211, 12),
}


def test_a_pair_keeps_what_the_file_wrote_and_knows_its_place() -> None:
    first, second = read_pairs(FILE.encode(), "gen/train.txt").records
    assert first.position == Position("gen/train.txt", 1)
    assert first.canonical_form == first.written_form == '( go " <room> " )'
    assert second.utterance == "go ,  please "
    assert (second.written_form, second.canonical_form) == ('(go "kitchen")', '( go " kitchen " )')
    assert second.position.line == 3


def test_a_file_is_written_back_byte_for_byte() -> None:
    records = read_pairs(FILE.encode(), "train.txt").records
    assert "".join(write_pairs((each.utterance, each.written_form) for each in records)) == FILE


@given(st.lists(st.tuples(st.text("aB ,'é.", min_size=1).filter(str.strip), forms()), max_size=3))
def test_any_pairs_survive_being_written(pairs: list[tuple[str, Form]]) -> None:
    written = [(text, to_corpus(form)) for text, form in pairs]
    again = read_pairs("".join(write_pairs(written)).encode(), "train.txt")
    if pairs:
        assert not any(problem.is_error for problem in again.problems)
    assert [(each.utterance, each.form) for each in again.records] == pairs


@pytest.mark.parametrize(
    ("text", "place", "named"),
    [
        ("go\n", "1:1", " 1 .* 2"),
        ("go\n(go 1)\ngo\n", "3:1", " 3 "),
        ("go\n(go $1)\n", "2:5", r"\$1"),
        ("go\ngo\n", "2:3", ""),
        ("\n(go 1)\n", "1:1", ""),
        ("go\n\n", "2:1", ""),
        ("", "1:1", ""),
        ("go\n" + "(" * 5000, "2:65", " 64 "),
    ],
)
def test_a_broken_pair_file_says_where_and_what(text: str, place: str, named: str) -> None:
    problem = read_pairs(text.encode(), "train.txt").problems[0]
    assert problem.is_error and str(problem.position) == f"train.txt:{place}"
    assert re.search(named, problem.message) and problem.hint


def test_what_is_not_utf8_text_is_refused() -> None:
    utf16 = read_pairs(FILE.encode("utf-16"), "train.txt")
    binary = read_pairs(b"\x89PNG\r\n\x1a\n\x00", "train.txt")
    assert "UTF-16" in utf16.problems[0].message
    assert not utf16.records and not binary.records
    assert binary.problems


def test_every_problem_of_a_file_is_reported_beside_what_is_right() -> None:
    file = read_pairs(b"a\n(\nb\n(go 1)\nc\n)\n", "train.txt")
    assert [problem.position.line for problem in file.problems] == [2, 6]
    assert [each.utterance for each in file.records] == ["b"]


def test_spaces_inside_the_quotation_marks_of_a_triple_become_one() -> None:
    text = 'walk to the attic\ngo to the attic\n( go "  small   attic  " )\n'
    (triple,) = read_triples(text.encode(), "paraphrasings.txt").records
    assert triple.paraphrase == "walk to the attic"
    assert triple.canonical_form == '( go " small attic " )'


def test_a_triple_with_a_line_missing_is_an_error() -> None:
    file = read_triples(b"a\n\n(go 1)\nb\nc\n", "paraphrasings.txt")
    assert [str(each.position) for each in file.problems] == [
        "paraphrasings.txt:2:1",
        "paraphrasings.txt:5:1",
    ]


def test_pairs_are_ordered_by_length_and_ties_keep_their_order() -> None:
    assert by_length([("bb", "1"), ("c", "2"), ("aa", "3")]) == [
        ("c", "2"),
        ("bb", "1"),
        ("aa", "3"),
    ]


@needs_corpus
@pytest.mark.parametrize("folder", CORPUS_FOLDERS)
@pytest.mark.parametrize("part", PART_FILES)
def test_the_published_pairs_come_back_byte_for_byte(folder: str, part: str) -> None:
    path = SHARED / "walker2019" / folder / PART_FILES[part]
    if not path.is_file():
        pytest.skip(f"{folder}/{path.name} is kept apart")
    data = path.read_bytes()
    file = read_pairs(data, path.name)
    count, distinct = PUBLISHED.get((folder, part), (len(file.records), None))
    assert not file.problems
    assert len(file.records) == count
    canonical = [each.canonical_form for each in file.records]
    assert distinct is None or len(set(canonical)) == distinct
    utterances = [each.utterance for each in file.records]
    assert "".join(write_pairs(zip(utterances, canonical, strict=True))).encode() == data
    assert [len(text) for text in utterances] == sorted(map(len, utterances))


@needs_corpus
def test_the_published_triples_are_read_whole() -> None:
    data = (SHARED / "walker2019" / "paraphrasings.txt").read_bytes()
    file = read_triples(data, "paraphrasings.txt")
    assert not file.problems
    assert len(file.records) == data.count(b"\n") // 3
    assert not any("  " in canonical_text(each.form) for each in file.records)


PAIRS = [("go to the attic", '( go " attic " )'), ("come", "( come )")]


def lines_of_pairs(*between: str) -> str:
    return "".join(f"{a}\n{b}\n{blank}" for (a, b), blank in zip(PAIRS, between, strict=True))


@pytest.mark.parametrize("blank", ["\n", "\n\n\n", "  \n", "\t\n \n", " "])
@pytest.mark.parametrize("where", ["between", "at the end", "both"])
def test_blank_lines_between_pairs_and_at_the_end_are_left_out(blank: str, where: str) -> None:
    if blank == " " and where != "at the end":
        blank = " \n"
    between = blank if where != "at the end" else "", blank if where != "between" else ""
    text = lines_of_pairs(*between)
    file = read_pairs(text.encode(), "train.txt")
    assert [(each.utterance, each.written_form) for each in file.records] == PAIRS
    assert not any(problem.is_error for problem in file.problems)
    first = 3 if where != "at the end" else 5
    assert (first, 1) in {(each.position.line, each.position.column) for each in file.problems}
    last = file.records[1].position.line
    assert text.split("\n")[last - 1] == "come"


@pytest.mark.parametrize(
    ("text", "lines", "utterances"),
    [
        ("a\n\n(go 1)\n", [], ["a"]),  # inside a pair
        ("\n\na\n(go 1)\n", [], ["a"]),
        ("a\n(go 1)\n\n(go 2)\nc\n(go 3)\n", [3], ["a", "c"]),  # a command is missing
        ("a\n\nb\n(go 2)\n", [2], ["b"]),  # a form is missing
        ("a\n(go 1)\n\nb\n(go $2)\n", [5], ["a"]),
        ("a\n(go 1)\n\nb\n", [4], ["a"]),
    ],
)
def test_errors_around_blank_lines_are_at_their_lines(
    text: str, lines: list[int], utterances: list[str]
) -> None:
    file = read_pairs(text.encode(), "train.txt")
    assert [each.position.line for each in file.problems if each.is_error] == lines
    assert [each.utterance for each in file.records] == utterances


@pytest.mark.parametrize("tail", ["\n", "\n\n", " \n\t\n"])
def test_blank_lines_between_triples_are_left_out(tail: str) -> None:
    one = "walk up\ngo to the attic\n( go 1 )\n"
    file = read_triples((one + tail + one + tail).encode(), "paraphrasings.txt")
    assert len(file.records) == 2 and not any(each.is_error for each in file.problems)
    assert file.records[1].position.line == 4 + tail.count("\n")


def test_what_an_export_does_not_keep_is_said() -> None:
    plain = lines_of_pairs("", "")
    for data, line in (
        (plain.replace("\n", "\r\n").encode(), 1),
        (b"\xef\xbb\xbf" + plain.encode(), 1),
        (plain.rstrip("\n").encode(), 4),
    ):
        file = read_pairs(data, "train.txt")
        assert [(each.position.line, each.is_error) for each in file.problems] == [(line, False)]
        assert [(each.utterance, each.written_form) for each in file.records] == PAIRS
    assert read_pairs(plain.encode(), "train.txt").problems == ()


def test_one_command_with_two_forms_is_a_warning_with_both_lines() -> None:
    text = "a\n(go 1)\nb\n(go 2)\na\n( go  1 )\na\n(go 3)\n"
    file = read_pairs(text.encode(), "train.txt")
    (problem,) = file.problems
    assert not problem.is_error and problem.position.line == 7 and "line 1" in problem.message
    assert len(file.records) == 4


def test_a_pair_file_is_read_normalised_and_each_changed_line_says_that_an_export_has_it_so() -> (
    None
):
    text = "go\u200b to the  cafe\u0301 \n(go 1)\nco\u2028me\n(go\xad\u20092)\nstay\n(go 3)\n"
    file = read_pairs(text.encode(), "train.txt")
    assert [(each.utterance, each.written_form) for each in file.records] == [
        ("go to the  caf\u00e9 ", "(go 1)"),
        ("co me", "(go 2)"),
        ("stay", "(go 3)"),
    ]
    assert [(each.position.line, each.is_error) for each in file.problems] == [
        (1, False),
        (3, False),
        (4, False),
    ]
    assert all("an export" in each.hint for each in file.problems)
    assert re.findall(r"\b\d+\b", file.problems[0].message)[:2] == ["1", "1"]


def test_triples_are_read_normalised() -> None:
    text = 'walk\u200d up\ngo\ufeff up\n( go " cafe\u0301 " )\n'
    file = read_triples(text.encode(), "paraphrasings.txt")
    (triple,) = file.records
    assert (triple.paraphrase, triple.command) == ("walk up", "go up")
    assert triple.canonical_form == '( go " caf\u00e9 " )'
    assert [each.position.line for each in file.problems] == [1, 2, 3]


@pytest.mark.parametrize("blank", ["\xa0", "\u3000", "\x1f", "\u2028", "\x85"])
def test_odd_blanks_are_spaces_and_a_warning_says_so(blank: str) -> None:
    file = read_pairs(f"go\n(go 1)\ngo{blank}up\n(go 2)\n".encode(), "train.txt")
    assert [each.utterance for each in file.records] == ["go", "go up"]
    (problem,) = file.problems
    assert problem.position.line == 3 and "an export" in problem.hint and not problem.is_error


@pytest.mark.parametrize("end", ["", "\n", "\n\u200b", "\n\u200b\n"])
def test_a_line_in_which_nothing_shows_is_a_blank_line(end: str) -> None:
    file = read_pairs(f"go\n(go 1)\n\u200b\u200d\nup\n(go 2){end}".encode(), "train.txt")
    assert [each.utterance for each in file.records] == ["go", "up"]
    assert 3 in [each.position.line for each in file.problems]
    assert not any(each.is_error for each in file.problems)


def test_a_file_in_which_nothing_shows_is_empty() -> None:
    (problem,) = read_pairs("\u200b\n\u200d\n".encode(), "train.txt").problems
    assert problem.is_error and problem.position.source == "train.txt"
