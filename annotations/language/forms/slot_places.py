"""Where the nonterminals and wildcards of a pattern or a form are, also in a text that cannot be read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from annotations.language.forms.reader import read_wildcard
from annotations.language.forms.symbols import Nonterminal, Wildcard
from annotations.language.texts import LanguageError

# A dollar sign before a digit is a variable of a form, not a nonterminal.
_SLOT = r"(?P<nonterminal>\$[^\W\d]\w*)|(?P<wildcard>\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\})"
_IN_PATTERN = re.compile(rf"\\.|{_SLOT}", re.DOTALL)
# The nonterminal that a line ``$name -> pattern`` is for.
_HEAD = re.compile(r"\s*\$(?P<name>[^\W\d]\w*)\s*->")
_IN_FORM = re.compile(rf'"[^"]*"|{_SLOT}')


@dataclass(frozen=True, slots=True)
class SlotPlace:
    """A nonterminal or a wildcard and the characters ``start`` to ``end`` that write it."""

    slot: Nonterminal | Wildcard
    start: int
    end: int

    @property
    def key(self) -> object:
        return slot_key(self.slot)


def slot_key(slot: Nonterminal | Wildcard) -> object:
    """Return what the two sides of a template have in common for one value; None without a value.

    Two nonterminals are one value by their name, two wildcards by name and number.
    """
    if isinstance(slot, Nonterminal):
        return slot
    return None if slot.kind == "void" else slot.identity


def split_head(text: str) -> tuple[str, int]:
    """Return the nonterminal that a left side is a line for, and where its pattern begins.

    ``$name -> pattern`` gives ``name``; a pattern of commands gives nothing, and 0.
    """
    head = _HEAD.match(text)
    return (head["name"], head.end()) if head else ("", 0)


def places_in_pattern(text: str) -> tuple[SlotPlace, ...]:
    """Return the slots of a pattern in order; what is in the note of a wildcard does not count.

    What stands before the arrow of a line is no slot of its pattern.
    """
    return tuple(_places(text, _IN_PATTERN, split_head(text)[1]))


def places_in_form(text: str) -> tuple[SlotPlace, ...]:
    """Return the slots of a form in order; what is between quotation marks does not count."""
    return tuple(_places(text, _IN_FORM))


def _places(text: str, pattern: re.Pattern[str], begin: int = 0) -> Iterator[SlotPlace]:
    for match in pattern.finditer(text, begin):
        if match["nonterminal"]:
            yield SlotPlace(Nonterminal(match["nonterminal"][1:]), match.start(), match.end())
        elif match["wildcard"]:
            try:
                yield SlotPlace(read_wildcard(match["wildcard"]), match.start(), match.end())
            except LanguageError:
                continue
