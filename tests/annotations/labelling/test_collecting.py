"""Utterances are collected whole or not at all, each once, with their entities found."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.labelling.collecting import MOST_AT_ONCE, _read, collect
from annotations.labelling.entity_spans import mend_span
from annotations.language.texts.errors import Refusal
from annotations.models import Entity


def test_entities_are_found(tiny_world, annotator):
    assert collect(tiny_world, ["find  the tea,", "", "go to the kitchen"], by=annotator).added == 2
    first, second = tiny_world.utterances.all()
    assert (first.text, first.anonymized_text) == ("find the tea,", "find the <object> ,")
    assert first.spans == [[9, 12, "object", "tea"]]
    assert second.anonymized_text == "go to the <room>"


def test_duplicates_are_reported_and_stored_once(tiny_world):
    collect(tiny_world, ["find the tea"])
    report = collect(tiny_world, ["find  the tea", "find it", "find it"])
    assert (report.added, report.duplicates) == (1, ("find the tea", "find it"))
    assert tiny_world.utterances.count() == 2


@pytest.mark.parametrize(
    ("texts", "line", "named"),
    [
        (["fine", "x" * 501], 2, " 501 "),
        (["a\0b"], 1, "U+0000"),
        (["x"] * (MOST_AT_ONCE + 1), MOST_AT_ONCE + 1, f"{MOST_AT_ONCE:,}"),
    ],
)
def test_with_an_error_nothing_is_stored(tiny_world, texts, line, named):
    (problem, *_) = collect(tiny_world, texts).problems
    assert problem.is_error and problem.position.line == line
    assert named in str(problem)
    assert not tiny_world.utterances.exists()


@given(st.lists(st.text(max_size=20), max_size=8))
def test_what_is_read_is_normalised(texts):
    wanted, problems = _read(texts)
    assert problems or all(text == " ".join(text.split()) and text for text in wanted)


def test_a_mended_span_becomes_an_alias_for_all(tiny_world, annotator):
    collect(tiny_world, ["bring my cuppa", "where is the cuppa"])
    first, second = tiny_world.utterances.all()
    tea = Entity.objects.get(text="tea")
    mended = mend_span(first, 9, 14, tea, annotator, 1)
    tea.refresh_from_db()
    second.refresh_from_db()
    assert tea.aliases == ["cuppa"]
    assert mended.anonymized_text == "bring my <object>"
    assert second.anonymized_text == "where is the <object>"
    assert mended.version == second.version == 2
    with pytest.raises(Refusal) as refused:
        mend_span(mended, 5, 5, tea, annotator, 2)
    assert refused.value.code == "no_words_selected"
