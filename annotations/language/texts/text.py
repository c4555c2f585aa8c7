"""Normalise what somebody wrote, so that texts that look equal are equal.

    >>> normalise_line("bring me the\\u200b caf" "e\\u0301")
    'bring me the café'

Every entrance uses it: pages, REST, files, archives, and the utterances that parsers are asked about.

- Characters that show nothing are removed: Unicode's control and format characters (categories Cc and
  Cf) and its default-ignorable ones. Among them are U+200B, the soft hyphen, byte-order marks, the marks
  and overrides of writing direction, tags, and variation selectors.
- The joiners U+200C and U+200D are removed too. In Persian, in Indic scripts and in emoji they choose
  how letters are drawn, and the same word is written with and without them. A robot's command has one
  spelling for one word; Unicode's own collation ignores them for the same reason.
- Every blank becomes U+0020, and every separator of lines becomes ``\\n`` or a blank.
- Letters are composed (NFC). Ligatures, full-width and mathematical letters and digits become plain ones: ﬁ is fi, Ａ
  is A. Scripts and texts copied out of a PDF have them, and they look as the plain ones do.

NUL and lone surrogates are no text at all. They stay, for the reader of the text to refuse them.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Self

from annotations.language.texts.errors import Position, Problem, Refusal, warning_at

# Unicode's stream-safe format allows as many marks on one letter. NFC sorts them in quadratic time.
MOST_MARKS = 30
MOST_WARNINGS = 20  # of one file: each names a line

# Categories Cc and Cf but for line ends, tab and NUL; what Unicode calls default-ignorable: the grapheme
# joiner, Khmer's inherent vowels, variation selectors, tags; and the code points that are no characters.
_INVISIBLE = re.compile(
    "["
    "\x01-\x08\x0e-\x1b\x7f-\x84\x86-\x9f\xad\u034f\u0600-\u0605\u061c\u06dd\u070f\u0890\u0891\u08e2"
    "\u17b4\u17b5\u180b-\u180f\u200b-\u200f\u202a-\u202e\u2060-\u206f\ufdd0-\ufdef\ufe00-\ufe0f\ufeff"
    "\ufff0-\ufffb\ufffe\uffff\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3"
    "\U0001d173-\U0001d17a\U000e0000-\U000e0fff"
    + "".join(
        f"{chr(plane + 0xFFFE)}{chr(plane + 0xFFFF)}" for plane in range(0x10000, 0x110000, 0x10000)
    )
    + "]"
)
# Category Zs, and what looks or acts like it: braille's empty cell, Hangul's fillers, and the control
# characters that Python takes for white space.
_ODD_BLANK = re.compile(
    "[\x0b\x0c\x1c-\x1f\xa0\u115f\u1160\u1680\u2000-\u200a\u202f\u205f\u2800\u3000\u3164\uffa0]"
)
# Letters and digits in another shape: ligatures, the long s, full-width and mathematical ones.
_SHAPED = re.compile(
    "[\u0132\u0133\u017f\ufb00-\ufb06\uff10-\uff19\uff21-\uff3a\uff41-\uff5a\U0001d400-\U0001d7ff]+"
)
_LINE_END = re.compile("\r\n|[\r\x85\u2028\u2029]")
_ODD_LINE_END = re.compile("[\x85\u2028\u2029]")
# Where more marks than MOST_MARKS can be, which is seldom.
_MANY_MARKS = re.compile(r"[^\x00-\x7f]{31,}")
_PLAIN = re.compile(r"[\t\n -~]*+")
_WORD_OR_SIGN = re.compile(r"\w+|[^\w\s]")


@dataclass(frozen=True, slots=True)
class TextChanges:
    """What normalising changed in a text, in characters. It is false if nothing that matters changed."""

    removed: int = 0
    composed: int = 0
    shaped: int = 0

    @classmethod
    def of(cls, text: str) -> Self:
        """Count what ``normalise`` changes in ``text``, blanks and line ends left out."""
        if _PLAIN.fullmatch(text):
            return cls()
        kept = _INVISIBLE.sub("", text)
        bounded = _bound_marks(kept)
        words = bounded.split()
        composed = sum(not unicodedata.is_normalized("NFC", word) for word in words)
        shaped = sum(bool(_SHAPED.search(word)) for word in words)
        return cls(len(text) - len(bounded), composed, shaped)

    def __bool__(self) -> bool:
        return bool(self.removed or self.composed or self.shaped)

    def __add__(self, other: TextChanges) -> TextChanges:
        return TextChanges(
            self.removed + other.removed,
            self.composed + other.composed,
            self.shaped + other.shaped,
        )

    def __str__(self) -> str:
        parts = []
        if self.removed:
            things = "invisible character was" if self.removed == 1 else "invisible characters were"
            parts.append(f"{self.removed:,} {things} removed")
        if self.composed:
            things = "word has" if self.composed == 1 else "words have"
            parts.append(f"{self.composed:,} {things} composed letters (Unicode NFC) now")
        if self.shaped:
            things = "word has" if self.shaped == 1 else "words have"
            parts.append(f"{self.shaped:,} {things} plain letters now for ligatures or wide ones")
        return ", ".join(parts)


def normalise(text: str) -> str:
    """Return a text that may have several lines; they end with ``\\n``. Tabs and runs of blanks stay."""
    if _PLAIN.fullmatch(text):
        return text
    text = _LINE_END.sub("\n", text)
    text = _ODD_BLANK.sub(" ", _INVISIBLE.sub("", text))
    text = _SHAPED.sub(lambda match: unicodedata.normalize("NFKC", match[0]), text)
    return unicodedata.normalize("NFC", _bound_marks(text))


def normalise_line(text: str) -> str:
    """Return a text as one line, with single blanks between its words and none around them."""
    return " ".join(normalise(text).split())


def normalise_record(text: str) -> str:
    """Return a text in whose records only ``\\n`` and CR end a line; any other separator becomes a blank.

    Runs of blanks stay. So records keep their number of lines, whatever stands in one of them.
    """
    return normalise(_ODD_LINE_END.sub(" ", text))


def normalise_json(value: Any) -> tuple[Any, TextChanges]:
    """Return parsed JSON with all its texts, and the names in its objects, as ``normalise_record`` gives them.

    Check the shape of the value first: it is followed however deep it nests.

    Returns:
        The value, and what changed in it.

    Raises:
        Refusal: two names in one object become the same.
    """
    match value:
        case str():
            return normalise_record(value), TextChanges.of(value)
        case list():
            items = [normalise_json(each) for each in value]
            return [item for item, _ in items], sum((each for _, each in items), TextChanges())
        case dict():
            names, of_names = normalise_json(list(value))
            if len(set(names)) < len(names):
                raise Refusal("two names in one object are the same", "equal_names")
            items, of_items = normalise_json(list(value.values()))
            return dict(zip(names, items, strict=True)), of_names + of_items
    return value, TextChanges()


def places_of(words: re.Pattern[str], text: str) -> list[tuple[int, int]]:
    """Return where the words of a text begin and end; ``words`` matches one.

    Vowel signs and accents that are characters of their own belong to their words. Fold what stands at these places
    word by word: folding a text moves its characters ("ß" becomes "ss"), so that no place in it is one of the text.
    """
    marked = "".join("_" if unicodedata.category(each)[0] == "M" else each for each in text)
    return [match.span() for match in words.finditer(marked)]


def find_words(wanted: str, text: str) -> tuple[int, int] | None:
    """Return where ``text`` first has the words of ``wanted``, whole and next to each other, ignoring case; None where
    it has not."""
    said = [wanted[start:end].casefold() for start, end in places_of(_WORD_OR_SIGN, wanted)]
    places = places_of(_WORD_OR_SIGN, text)
    words = [text[start:end].casefold() for start, end in places]
    for first in range(len(words) - len(said) + 1 if said else 0):
        if words[first : first + len(said)] == said:
            return places[first][0], places[first + len(said) - 1][1]
    return None


def has_half_character(text: str) -> bool:
    """Whether ``text`` holds a lone surrogate, which no file and no database can hold."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return True
    return False


def changes_by_line(text: str, source: str = "") -> list[Problem]:
    """Return a warning for each line of a file that normalising changes; those beyond ``MOST_WARNINGS`` are counted."""
    if _PLAIN.fullmatch(text):
        return []
    changed = [
        (Position(source, number), changes)
        for number, line in enumerate(_LINE_END.sub("\n", text).split("\n"), start=1)
        if (changes := TextChanges.of(line))
    ]
    return say_changes(changed)


def say_changes(changed: Sequence[tuple[Position, TextChanges]], hint: str = "") -> list[Problem]:
    """Return a warning with ``hint`` for each of the first changed lines, and one that counts the rest."""
    warnings = [
        warning_at(place, f"{changes} in line {place.line}", hint)
        for place, changes in changed[:MOST_WARNINGS]
    ]
    if rest := changed[MOST_WARNINGS:]:
        total = sum((changes for _, changes in rest), TextChanges())
        lines = "1 further line" if len(rest) == 1 else f"{len(rest):,} further lines"
        warnings.append(warning_at(rest[0][0], f"{total} in {lines}", hint))
    return warnings


def _bound_marks(text: str) -> str:
    """Return ``text`` without the marks on a letter beyond ``MOST_MARKS``."""
    return _MANY_MARKS.sub(lambda match: "".join(_bounded(match[0])), text)


def _bounded(text: str) -> Iterator[str]:
    marks = 0
    for character in text:
        marks = marks + 1 if unicodedata.combining(character) else 0
        if marks <= MOST_MARKS:
            yield character
