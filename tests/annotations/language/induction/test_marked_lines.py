"""Lines with marks: what is read, what is refused, and that they print as they are read."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import read_form
from annotations.language.induction import MOST_LINES, Example, Mark, read_example, read_examples
from annotations.language.texts import LanguageError

WORDS = st.sampled_from(["water", "the", "bed", "two", "of", "roses", "x-ray", "Mr"])
TEXTS = st.lists(WORDS, min_size=1, max_size=3).map(" ".join)
MARKS = st.builds(Mark, TEXTS, st.sampled_from(["", "plant", "bed"]))
_MEANINGS: list[dict[str, Any]] = [{}, {"action": "water"}, {"form": read_form('(water "roses")')}]
MEANINGS = st.sampled_from(_MEANINGS)


@given(st.lists(WORDS | MARKS, min_size=1, max_size=8), MEANINGS)
def test_an_example_reads_back_from_its_line(
    parts: list[str | Mark], meaning: dict[str, Any]
) -> None:
    once = read_example(str(Example(("prune", *parts), **meaning)))
    assert read_example(str(once)) == once


@pytest.mark.parametrize(
    "line, parts",
    [
        ("water the [roses]", ("water", "the", Mark("roses"))),
        ("Please water the [roses](plant), thanks!", ("water", "the", Mark("roses", "plant"))),
        ("could you water [bed  two].", ("water", Mark("bed two"))),
        ("moor at [the dry dock](pier)", ("moor", "at", "the", Mark("dry dock", "pier"))),
        ("visit [The Hague]", ("visit", Mark("The Hague"))),
        ("go, then stop", ("go", ",", "then", "stop")),
        ("thanks", ("thanks",)),
        ("check if [room two] is empty", ("check", "if", Mark("room two"), "is", "empty")),
        ("don't enter [room two] = avoid", ("don't", "enter", Mark("room two"))),
    ],
)
def test_what_is_said_out_of_courtesy_is_left_out(line: str, parts: tuple[str | Mark, ...]) -> None:
    assert read_example(line).parts == parts


@pytest.mark.parametrize(
    "line, column",
    [
        ("water the [roses", 11),
        ("water the roses]", 16),
        ("water the []", 11),
        ("water the [roses](Two)", 11),
        ("water = the roses", 9),
        ("water = (water", 15),
        (", ,", 1),
        ("if it rains, close the [skylight]", 1),
        ("close the [skylight] if it rains", 1),
        ("close the [skylight] unless it is hot", 1),
        ("don't enter the [orchard]", 1),
        ("please do not enter the [orchard]", 1),
    ],
)
def test_a_line_that_is_no_example_is_refused_where_it_goes_wrong(line: str, column: int) -> None:
    with pytest.raises(LanguageError) as refused:
        read_example(line)
    assert refused.value.position.column == column


def test_lines_are_read_once_and_only_so_many() -> None:
    text = "\n".join(["stop", "", "# a comment", "stop", "water the [roses", *["go"] * MOST_LINES])
    examples, problems = read_examples(text)
    assert [str(each) for each in examples] == ["stop", "go"]
    assert [each.position.line for each in problems] == [5, MOST_LINES + 1]
