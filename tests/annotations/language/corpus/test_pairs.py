from __future__ import annotations

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
from annotations.language.errors import Position
from annotations.language.forms import Form, canonical_text, to_corpus
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
        assert not again.problems
    assert [(each.utterance, each.form) for each in again.records] == pairs


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("go\n", "train.txt:1:1: error: the file has 1 lines, which is not a multiple of 2"),
        ("go\n(go 1)\ngo\n", "train.txt:3:1: error: the file has 3 lines"),
        ("go\n(go $1)\n", "train.txt:2:5: error: no λ binds the variable $1"),
        ("go\ngo\n", "train.txt:2:3: error: the form ends too early"),
        ("\n(go 1)\n", "train.txt:1:1: error: there is no command here"),
        ("go\n\n", "train.txt:2:1: error: there is no form here"),
        ("", "train.txt:1:1: error: the file is empty"),
        ("go\n" + "(" * 5000, "train.txt:2:65: error: the form nests more than 64 deep"),
    ],
)
def test_a_broken_pair_file_says_where_and_what(text: str, expected: str) -> None:
    file = read_pairs(text.encode(), "train.txt")
    assert str(file.problems[0]).startswith(expected)
    assert file.problems[0].hint


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
