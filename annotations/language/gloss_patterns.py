"""Gloss patterns: how a predicate is said in English.

A pattern is a list of alternatives separated by ``|``; the one that uses most of the arguments
wins, then the one that says most about their kinds, then the first. In an alternative

- ``{2}`` is the second argument; ``{2:room}`` asks that it be of that kind; ``{2:text}`` takes a
  text written out and gives it without an article, as ``{2:name}`` does with a name; ``{1:plural}``
  says "objects", not "the object"; ``{2=current}`` asks for that text (or for ``UNKNOWN``) and says
  nothing; ``{*}`` is all arguments, in order;
- ``_`` in a description is the noun that it describes: ``heaviest _``, ``_ that is at {2}``. A
  description without ``_`` gives the noun itself: ``person``. Its ``{1}`` is what it describes;
- ``=`` in front of an action marks what it is called inside another: ``= the number of {1:plural}``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from annotations.language.signatures import ArgumentKind, Signature

_SLOT = re.compile(r"\{(?P<place>\d+|\*)(?::(?P<kind>\w+)|=(?P<value>[^{}]*))?\}")


@dataclass(frozen=True, slots=True)
class Slot:
    """An argument in a pattern; ``place`` counts from 0 and is None for ``{*}``."""

    place: int | None
    kind: str = ""
    value: str = ""


@dataclass(frozen=True, slots=True)
class Alternative:
    """Texts and slots in turn; ``is_nested`` for one marked with ``=``."""

    pieces: tuple[str | Slot, ...]
    is_nested: bool = False

    @property
    def slots(self) -> tuple[Slot, ...]:
        return tuple(piece for piece in self.pieces if isinstance(piece, Slot))


@lru_cache(maxsize=1 << 12)
def read_pattern(pattern: str) -> tuple[Alternative, ...]:
    """The alternatives of a pattern. Anything is a pattern: what is no slot is text."""
    return tuple(_alternative(part.strip()) for part in pattern.split("|"))


def default_pattern(name: str, is_action: bool, signatures: tuple[Signature, ...]) -> str:
    """The pattern of a predicate of the published corpus, else one made from the name."""
    return KNOWN_PATTERNS.get(name) or pattern_of_name(name, is_action, signatures)


def pattern_of_name(name: str, is_action: bool, signatures: tuple[Signature, ...]) -> str:
    """A pattern made from the words of the name and what the predicate takes, and nothing else."""
    words = name.replace("_", " ").replace("-", " ").strip() or name
    arities = sorted({len(each.arguments) for each in signatures}) or [1]
    if is_action:
        return " | ".join(_action(words, arity, signatures) for arity in arities)
    return " | ".join(dict.fromkeys(_description(name, words, arity) for arity in arities))


def _alternative(text: str) -> Alternative:
    is_nested = text.startswith("=")
    pieces: list[str | Slot] = []
    end = 0
    text = text.removeprefix("=").strip()
    for match in _SLOT.finditer(text):
        place = None if match["place"] == "*" else int(match["place"]) - 1
        pieces += [
            text[end : match.start()],
            Slot(place, match["kind"] or "", match["value"] or ""),
        ]
        end = match.end()
    return Alternative(tuple(piece for piece in (*pieces, text[end:]) if piece), is_nested)


def _action(words: str, arity: int, signatures: tuple[Signature, ...]) -> str:
    """``verb {1} preposition {2}``, the preposition by what the argument is."""
    kinds = next(each.arguments for each in signatures if len(each.arguments) == arity)
    later = (f"{_PREPOSITIONS.get(kind, 'with')} {{{n}}}" for n, kind in enumerate(kinds[1:], 2))
    return " ".join((words, *(["{1}"] if arity else []), *later))


def _description(name: str, words: str, arity: int) -> str:
    if arity <= 1:
        return f"_ that is {words}" if name.endswith("ing") else f"{words} _"
    if name.endswith(("est", "most")):
        return f"{{2}} {words} _"
    if name.startswith(("is_", "has_", "can_")):
        return f"_ that {words} {{2}}"
    if name in _RELATIONS or name.endswith(("_of", "_to", "_by")):
        return f"_ that is {words} {{2}}"
    return f"_ whose {words} is {{2:text}} | _ whose {words} is {{2}}"


_RELATIONS = frozenset(
    ["at", "in", "on", "near", "above", "below", "behind", "under", "beside", "inside", "over"]
)
_PREPOSITIONS = {
    ArgumentKind.LAMBDA: "for",
    ArgumentKind.NAME: "for",
    ArgumentKind.LOCATION: "at",
    ArgumentKind.ROOM: "in",
}

# The predicates of the published corpus and their neighbours.
KNOWN_PATTERNS = {
    "bring": "bring me {1} | bring {1} to {2:lambda} | bring me {1} from {2}",
    "put": "take {1} and put it on {2} | take {1} and put it somewhere{2=UNKNOWN}",
    "pour": "pour {1} into {2}",
    "find": "find {1} | find {2} {1:plural}",
    "follow": "follow {1} | follow someone{1=UNKNOWN} | follow {1} to {2}",
    "go": "go to {1} | go somewhere{1=UNKNOWN}",
    "guide": "guide {1} | guide {1} to {2} | guide {1} somewhere{2=UNKNOWN} | "
    "guide {1} back{2=current}",
    "say": "tell me {1} | say {1} | say {1} to {2} | {1:form} for {2} | tell {2} {1:text}",
    "answer": "answer {1} | answer {1} for {2}",
    "count": "count {1:plural} | = the number of {1:plural}",
    "sequence": "{*}",
    "and": "{*}",
    "person": "person",
    "is_a": "{2} | object of {2:category}",
    "name": "_ named {2:text} | _ with the given {2:name}",
    "at": "_ that is at {2} | _ that is in {2:room}",
    **dict.fromkeys(("is", "gesture"), "_ that is {2:text} | _ that is making {2}"),
    "male": "male _",
    "female": "female _",
    "lying": "_ that is lying down",
    "sitting": "_ that is sitting",
    "standing": "_ that is standing",
    "leftmost": "leftmost _ | leftmost _ at {2}",
    "rightmost": "rightmost _ | rightmost _ at {2}",
    "left_of": "_ to the left of {2}",
    "right_of": "_ to the right of {2}",
    "on_top_of": "_ on top of {2}",
    "above": "_ above {2}",
    "below": "_ under {2}",
    "behind": "_ behind {2}",
    **{
        name: f"{name} _ | {{2}} {name} _"
        for name in ("biggest", "largest", "smallest", "heaviest", "lightest", "thinnest")
    },
}
