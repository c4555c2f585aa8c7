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
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from annotations.language.texts import KNOWN_PATTERNS, PREPOSITIONS, RELATIONS
from annotations.language.world.signatures import Signature

SUPERLATIVES = ("est", "most")  # how the names of predicates end that choose one among several
_PLAIN_SLOT = re.compile(r"\{[1-9][0-9]?\}")
ALL_IN_ORDER = "{*}"  # how a sequence is said
_SLOT = re.compile(r"\{(?P<place>[1-9][0-9]?|\*)(?::(?P<kind>\w+)|=(?P<value>[^{}]*))?\}")


@dataclass(frozen=True, slots=True)
class PatternSlot:
    """An argument in a pattern; ``place`` counts from 0 and is None for ``{*}``."""

    place: int | None
    kind: str = ""
    value: str = ""

    def with_names(self, names: Sequence[str]) -> str:
        """Return the argument as ``{plant}``, by its name, or as ``{plants:plural}``; empty for what is not said."""
        if self.place is None:
            return ", then ".join(f"{{{each}}}" for each in names)
        if self.value or self.place >= len(names):
            return ""
        return f"{{{names[self.place]}{':plural' if self.kind == 'plural' else ''}}}"


@dataclass(frozen=True, slots=True)
class GlossAlternative:
    """Texts and slots in turn; ``is_nested`` for one marked with ``=``."""

    pieces: tuple[str | PatternSlot, ...]
    is_nested: bool = False

    @property
    def slots(self) -> tuple[PatternSlot, ...]:
        return tuple(piece for piece in self.pieces if isinstance(piece, PatternSlot))


@lru_cache(maxsize=1 << 12)
def read_pattern(pattern: str) -> tuple[GlossAlternative, ...]:
    """Return the alternatives of a pattern. Any text is a pattern: what is not a slot is plain text."""
    alternatives: list[GlossAlternative] = []
    for part in map(str.strip, pattern.split("|")):
        text = part.removeprefix("=").strip()
        pieces: list[str | PatternSlot] = []
        end = 0
        for match in _SLOT.finditer(text):
            place = None if match["place"] == "*" else int(match["place"]) - 1
            slot = PatternSlot(place, match["kind"] or "", match["value"] or "")
            pieces += [text[end : match.start()], slot]
            end = match.end()
        spoken = tuple(piece for piece in (*pieces, text[end:]) if piece)
        alternatives.append(GlossAlternative(spoken, is_nested=part.startswith("=")))
    return tuple(alternatives)


def default_pattern(name: str, is_action: bool, signatures: tuple[Signature, ...]) -> str:
    """Return the pattern of a predicate of the published corpus, or else one made from the name.

    It says every argument of the signatures: a known pattern is made longer where it has too few.
    """
    pattern = KNOWN_PATTERNS.get(name) or pattern_of_name(name, is_action, signatures)
    return lengthen(pattern, is_action, signatures)


def lengthen(pattern: str, is_action: bool, signatures: Iterable[Signature]) -> str:
    """Return the pattern with further alternatives, so that it says every argument of the signatures."""
    return " | ".join([pattern, *_longer_alternatives(pattern, is_action, signatures)])


def _longer_alternatives(
    pattern: str, is_action: bool, signatures: Iterable[Signature]
) -> Iterator[str]:
    """Yield an alternative for each signature with an argument that no alternative of ``pattern`` mentions.

    The first argument of a description is what it describes, and is not said.
    """
    places = {slot.place for each in read_pattern(pattern) for slot in each.slots}
    if None in places:  # all arguments, in order
        return
    longest = max(pattern.split("|"), key=lambda each: len(_PLAIN_SLOT.findall(each))).strip()
    for signature in signatures:
        unsaid = [
            f"{PREPOSITIONS.get(kind, 'with')} {{{place + 1}}}"
            for place, kind in enumerate(signature.arguments)
            if place not in places and (is_action or place > 0)
        ]
        if unsaid:
            yield " ".join([longest, *unsaid])


def pattern_of_name(name: str, is_action: bool, signatures: tuple[Signature, ...]) -> str:
    """Make a pattern from the words of the name and from what the predicate takes, and nothing else."""
    words = name.replace("_", " ").replace("-", " ").strip() or name
    arities = sorted({len(each.arguments) for each in signatures}) or [1]
    if not is_action:
        return " | ".join(dict.fromkeys(_description(name, words, arity) for arity in arities))
    patterns = []  # ``verb {1} preposition {2}``; the preposition depends on the kind of the argument
    for arity in arities:
        kinds = next(each.arguments for each in signatures if len(each.arguments) == arity)
        later = [f"{PREPOSITIONS.get(kind, 'with')} {{{n}}}" for n, kind in enumerate(kinds[1:], 2)]
        patterns.append(" ".join([words, *["{1}"] * (arity > 0), *later]))
    return " | ".join(patterns)


def _description(name: str, words: str, arity: int) -> str:
    if arity <= 1:
        return f"_ that is {words}" if name.endswith("ing") else f"{words} _"
    if name.endswith(SUPERLATIVES):
        return f"{{2}} {words} _"
    if name.startswith(("is_", "has_", "can_")):
        return f"_ that {words} {{2}}"
    if name in RELATIONS or name.endswith(("_of", "_to", "_by")):
        return f"_ that is {words} {{2}}"
    return f"_ whose {words} is {{2:text}} | _ whose {words} is {{2}}"
