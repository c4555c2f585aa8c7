"""Words that make another request of a command: that forbid it, set a condition, or ask for several things.

No form has a place for them, so a parser that answers with the rest does what nobody asked for: "don't bring me the
honey" brings the honey.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from annotations.language.english import (
    CONDITIONAL_PHRASES,
    FORBIDDING_PHRASES,
    NUMBERS,
    POLITE_BEFORE_IF,
)
from annotations.language.grounding import Anonymized


def _any_of(phrases: Iterable[str]) -> str:
    return rf"\b(?:{'|'.join(map(re.escape, phrases))})\b"


_QUALIFIED = re.compile(rf"{_any_of((*FORBIDDING_PHRASES, *CONDITIONAL_PHRASES))}", re.IGNORECASE)
_IF = re.compile(r"\bif\b", re.IGNORECASE)
_POLITE_IF = re.compile(rf"{_any_of(POLITE_BEFORE_IF)},? if\b", re.IGNORECASE)
_NUMBER_BEFORE = re.compile(
    rf"(?:{_any_of((*NUMBERS[2:], 'both', 'every', 'each'))}|\b(?:[2-9]|[1-9]\d+))\s+(?:of\s+)?(?:the\s+)?$",
    re.IGNORECASE,
)


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
