"""No regular expression of the project costs more than linear time, whatever is written."""

from __future__ import annotations

import shutil

import pytest

from benchmarks.language.hostile_patterns import (
    UsedPattern,
    all_patterns,
    script_patterns,
    slow_script_texts,
    slow_text,
)


def test_patterns_are_linear():
    patterns = all_patterns()
    assert {"route", "annotations/language/forms/logic.lark"} <= {
        each.place.split()[0].split(":")[0] for each in patterns
    }
    assert [str(slow) for slow in map(slow_text, patterns) if slow] == []


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node")
def test_patterns_of_scripts_are_linear():
    patterns = list(script_patterns())
    assert len(patterns) > 20
    assert [str(slow) for slow in slow_script_texts(patterns)] == []


@pytest.mark.parametrize(
    ("source", "method"),
    [
        (r"\s+$", "search"),  # starts again at each blank
        (r"\s*(?:\((?P<inside>[^()]*)\)|(?P<bare>[^()]*))\s*", "fullmatch"),  # cubic
        (r"(?:a|b|ab)*c", "match"),
        (r"(\w+\s?)*;", "match"),  # exponential
        (r"\{[^}]*\}", "finditer"),
        (r"<!--.*?-->", "sub"),
        (r"key\s+name\s+(.+?)\s*", "fullmatch"),
        (r"r/(.+)/(.+)/\Z", "fullmatch"),
    ],
)
def test_slow_patterns_are_known(source, method):
    assert slow_text(UsedPattern("here", source, 0, (method,)))


@pytest.mark.parametrize("source", [r"\s++$", r"\{[^{}]*\}", r"(?<!\d)\d+$", r"\w+:\w+"])
def test_linear_patterns_are_left_alone(source):
    assert slow_text(UsedPattern("here", source, 0, ("match", "fullmatch"))) is None


def test_a_bounded_repetition_is_linear():
    used = UsedPattern("here", r"-?[0-9]{1,40}(?!\w)", 0, ("finditer",))
    assert slow_text(used) is None
