"""Words that make another request of a command: that forbid it, set a condition, or ask for several things.

No form has a place for them, so a parser that answers with the rest does what nobody asked for: "don't bring me the
honey" brings the honey.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum

from annotations.language.english import (
    ASKING_PHRASES,
    CONDITIONAL_PHRASES,
    FINISHED_WORDS,
    FORBIDDING_PHRASES,
    NUMBERS,
    POLITE_BEFORE_IF,
    TAKING_BACK_PHRASES,
)
from annotations.language.grounding import Anonymized


def _any_of(phrases: Iterable[str]) -> str:
    return rf"\b(?:{'|'.join(map(re.escape, phrases))})\b"


_QUALIFIED = re.compile(rf"{_any_of((*FORBIDDING_PHRASES, *CONDITIONAL_PHRASES))}", re.IGNORECASE)
_ASKED = re.compile(_any_of(ASKING_PHRASES), re.IGNORECASE)
# "As soon as you are done" is no condition: it speaks of the command before.
_DONE = re.compile(
    rf"{_any_of((*CONDITIONAL_PHRASES, 'if'))}\s+(?:possible\b|(?:you|that|this|it|they)(?:'\w+)?"
    rf"(?:\s+[\w']+){{0,3}}?\s+{_any_of(FINISHED_WORDS)})",
    re.IGNORECASE,
)
# "It would make my day if you came" is a wish.
_WISH = re.compile(r"\b(?:i|it|we|that)(?:'d| would)(?:\s+[\w']+){0,5}?\s+if\b", re.IGNORECASE)
_IF = re.compile(r"\bif\b", re.IGNORECASE)
_POLITE_IF = re.compile(rf"{_any_of(POLITE_BEFORE_IF)},? if\b", re.IGNORECASE)
_NUMBER_BEFORE = re.compile(
    rf"(?:{_any_of((*NUMBERS[2:], 'both', 'every', 'each'))}|\b(?:[2-9]|[1-9]\d+))\s+(?:of\s+)?(?:the\s+)?$",
    re.IGNORECASE,
)


class Hold(Enum):
    """What keeps a robot from doing what is said: it is forbidden, it has a condition, or it is taken back."""

    FORBIDDEN = re.compile(_any_of(FORBIDDING_PHRASES), re.IGNORECASE)
    CONDITION = re.compile(_any_of((*CONDITIONAL_PHRASES, "if")), re.IGNORECASE)
    TAKEN_BACK = re.compile(_any_of(TAKING_BACK_PHRASES), re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Held:
    """Words that forbid a command, set a condition or take back; ``start`` is their place in the utterance."""

    start: int
    hold: Hold


def holds_in(utterance: str) -> Iterator[Held]:
    """Yield what forbids, sets a condition or takes back, kind by kind. Takes linear time.

    "I would be glad if you came" sets no condition, and "don't forget to come" forbids nothing.
    """
    text = utterance.replace("’", "'")
    harmless = bytearray(len(text))
    for words in (_ASKED, _DONE, _WISH, _POLITE_IF):
        for match in words.finditer(text):
            harmless[match.start() : match.end()] = b"\1" * len(match[0])
    for hold in Hold:
        for match in hold.value.finditer(text):
            if not harmless[match.start()]:
                yield Held(match.start(), hold)


def is_qualified(utterance: str) -> bool:
    """Return whether an utterance forbids what it says, or sets a condition.

    "I would be glad if you came" sets none. Takes linear time.
    """
    text = utterance.replace("’", "'")
    if _QUALIFIED.search(text):
        return True
    return len(_IF.findall(text)) > len(_POLITE_IF.findall(text))


def says_number(heard: Anonymized) -> bool:
    """Return whether an utterance asks for several of what it names: "two apples", "both cups"."""
    return any(_NUMBER_BEFORE.search(heard.original[: span.start][-40:]) for span in heard.spans)
