"""What reads, checks and compares texts of people costs no more than linear time, or is bounded."""

from __future__ import annotations

import time
from functools import lru_cache

import pytest

from annotations.language.forms import diff, diff_unordered, read_form
from annotations.showing.form_presentation import compare, merge_words
from benchmarks.language.hostile_patterns import HostileText, seconds
from benchmarks.language.hostile_readings import READERS, SIZES, UNITS, slow_reading

BOUND = 0.5  # seconds of processor time for one comparison, ten times what it takes


@pytest.mark.parametrize("reader", READERS)
def test_readers_are_linear(reader):
    texts = [HostileText("", unit, "") for unit in UNITS]
    assert [str(slow) for text in texts if (slow := slow_reading(reader, text))] == []


def test_a_reader_that_remembers_what_it_read_is_known_to_be_slow(monkeypatch):
    @lru_cache
    def read(text):
        return [text.count("(b", 0, end) for end in range(len(text)) for _ in range(3)]

    monkeypatch.setitem(READERS, "remembers", read)
    assert slow_reading("remembers", HostileText("", "(a|b)", ""))


def test_a_reader_that_a_busy_machine_holds_up_is_left_alone(monkeypatch):
    longest = []

    def read(text):
        longest.extend([text] if len(text) >= SIZES[-1] else [])
        until = time.process_time() + (0.2 if len(longest) == 1 else 0.001)
        while time.process_time() < until:
            pass

    monkeypatch.setitem(READERS, "held up", read)
    assert slow_reading("held up", HostileText("", "a", "")) is None
    assert len(longest) > 1


@pytest.mark.parametrize("compared", [compare, merge_words])
def test_comparing_words_is_bounded(compared):
    old, new = "a " * 999, "b a " * 500
    assert seconds(lambda: compared(old, new), 3) < BOUND


@pytest.mark.parametrize("compared", [diff, diff_unordered])
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('(g "x") ', '(h "y") '),
        ('(and (g "x") (h "x")) ', '(and (h "x") (g "y")) '),
        ("$1 ", "$1 "),
    ],
)
def test_comparing_forms_is_bounded(compared, old, new):
    left, right = (
        read_form("(λ$1:e (f " + each * (4_800 // len(each)) + "))") for each in (old, new)
    )
    assert seconds(lambda: compared(left, right), 3) < BOUND


def test_long_forms_are_compared_by_their_places():
    left = read_form("(f " + '(g "x") ' * 500 + ")")
    right = read_form("(f " + '(g "x") ' * 250 + '(h "y") ' + '(g "x") ' * 252 + ")")
    changes = diff(left, right)
    assert [str(each.change) for each in changes.children].count("added") == 3
    assert changes.children[250].cost == 2 and changes.cost == 2 + 3 * 2
