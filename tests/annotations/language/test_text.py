"""Texts that look equal are equal: one normal form for everything that people write."""

from __future__ import annotations

import sys
import unicodedata
from functools import cache

import pytest

from annotations.language.texts.decoding import decode, read_text
from annotations.language.texts.errors import LanguageError, Severity
from annotations.language.texts.text import (
    MOST_MARKS,
    MOST_WARNINGS,
    TextChanges,
    changes_by_line,
    has_half_character,
    normalise,
    normalise_line,
)
from tests.timing import least_seconds

LINE_ENDS = "\n\r\x85\u2028\u2029"
INVISIBLE = {
    "zero-width space": "\u200b",
    "non-joiner": "\u200c",
    "joiner": "\u200d",
    "left-to-right mark": "\u200e",
    "right-to-left mark": "\u200f",
    "override": "\u202e",
    "embedding": "\u202a",
    "isolate": "\u2066",
    "end of isolate": "\u2069",
    "soft hyphen": "\xad",
    "byte-order mark": "\ufeff",
    "word joiner": "\u2060",
    "tag": "\U000e0041",
    "variation selector": "\ufe0f",
    "variation selector 256": "\U000e01ef",
    "Mongolian vowel separator": "\u180e",
    "grapheme joiner": "\u034f",
    "bell": "\x07",
    "delete": "\x7f",
    "C1": "\x90",
    "no character": "\uffff",
}


@cache
def every_character() -> list[str]:
    return [chr(code) for code in range(sys.maxunicode + 1) if not 0xD800 <= code < 0xE000]


def test_no_control_or_format_character_of_this_unicode_is_left():
    for character in set(normalise("b".join(every_character()))):
        category = unicodedata.category(character)
        assert category not in ("Cf", "Zl", "Zp"), hex(ord(character))
        assert category != "Cc" or character in "\0\t\n", hex(ord(character))
        assert category != "Zs" or character == " ", hex(ord(character))


def test_normalising_twice_changes_nothing_more():
    once = normalise("".join(f"a{each}\u0301{each} " for each in every_character()))
    assert normalise(once) == once
    assert normalise_line(normalise_line(once)) == normalise_line(once)


@pytest.mark.parametrize("character", INVISIBLE.values(), ids=INVISIBLE)
def test_what_shows_nothing_is_removed_and_counted(character):
    for written in (f"{character}the plum", f"the pl{character}um", f"the plum{character}"):
        assert normalise_line(written) == "the plum"
        assert TextChanges.of(written) == TextChanges(removed=1)


@pytest.mark.parametrize("blank", ["\xa0", "\u3000", "\u2009", "\u202f", "\u2800", "\t", "\x1f"])
def test_blanks_become_one_space_in_a_line(blank):
    assert normalise_line(f"{blank}the{blank} {blank}plum{blank}") == "the plum"
    assert not TextChanges.of(f"the{blank}plum")


def test_letters_are_composed():
    assert normalise("cafe\u0301") == "caf\u00e9"
    assert normalise("e\u200d\u0301") == "\u00e9"
    assert TextChanges.of("the cafe\u0301") == TextChanges(composed=1)


@pytest.mark.parametrize("end", ["\r\n", *LINE_ENDS])
def test_lines_are_kept_in_a_text_of_several(end):
    assert normalise(f"one{end}two") == "one\ntwo"
    assert normalise_line(f"one{end}two") == "one two"


def test_indents_tabs_and_empty_lines_are_kept():
    assert normalise("- one\n\n    code\twide  gap\n") == "- one\n\n    code\twide  gap\n"


def test_ordinary_texts_of_any_script_stay_as_they_are():
    for text in (
        "Antônia",
        "λ$1:e",
        "“quoted” – dash",
        "北京",
        "한국어",
        "हिन्दी",
        "فارسی",
        "🤖 👍🏽",
    ):
        assert normalise(text) == text and not TextChanges.of(text)


def test_one_word_has_one_spelling_with_and_without_joiners():
    assert normalise("می\u200cخواهم") == normalise("میخواهم")
    assert normalise("👩\u200d🚒") == "👩🚒"


def test_nul_and_lone_surrogates_are_left_for_the_reader_to_refuse():
    assert normalise("a\0b") == "a\0b"
    assert normalise("a\ud83db") == "a\ud83db" and has_half_character("a\ud83db")
    assert not has_half_character("🤖")


def test_changes_are_said_with_the_line():
    problems = changes_by_line("one\ntw\u200bo\u200b \u202e\nthr\u00e9e\nfoure\u0301\n", "a.txt")
    assert [(str(each.position), each.severity) for each in problems] == [
        ("a.txt:2:1", Severity.WARNING),
        ("a.txt:4:1", Severity.WARNING),
    ]
    assert "3 " in problems[0].message and "line 2" in problems[0].message


def test_many_changed_lines_are_counted():
    problems = changes_by_line("a\u200b\n" * (MOST_WARNINGS + 7))
    assert len(problems) == MOST_WARNINGS + 1
    assert "7 invisible" in problems[-1].message and problems[-1].position.line == MOST_WARNINGS + 1


def test_a_file_is_read_normalised_or_as_it_is():
    data = "\ufeffpl\u200bum\r\n".encode()
    text, problems = read_text(data, "a.txt")
    assert text == "plum\n" and len(problems) == 1
    assert decode(data, "a.txt") == "pl\u200bum\n"
    with pytest.raises(LanguageError):
        read_text("\u200b\u200b".encode(), "a.txt")


@pytest.mark.parametrize(
    "hostile", ["a\u0301\u0323", "\u0301\u0323", "\u200b", "\xa0", "e\u0301", "\u1100\u1161"]
)
def test_time_is_linear_in_the_length(hostile):
    def seconds(count: int) -> float:
        text = hostile * count
        return least_seconds(
            lambda: (normalise_line(text), TextChanges.of(text), changes_by_line(text))
        )

    assert seconds(16_000) < 12 * seconds(4_000) + 0.01


def test_marks_on_one_letter_are_bounded():
    clean = normalise("a" + "\u0301\u0323" * 50_000 + "b")
    assert len(clean) <= MOST_MARKS + 2 and clean.endswith("b")
