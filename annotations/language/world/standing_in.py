"""Tell which texts can be put into a gloss that was made with signs in their places (``english.stand_in``).

A gloss depends on the texts of its form in a few ways only. All of them are checked here, so that a gloss
with texts put in equals the gloss that is made from the texts.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from annotations.language.forms import PERSON, Constant
from annotations.language.texts import KNOWN_PATTERNS, STAND_IN, article, looks_plural
from annotations.language.world.gloss_patterns import read_pattern
from annotations.language.world.predicates import Predicate

_SIGN = STAND_IN.pattern
_TOUCHING = re.compile(rf"(?:\w|{_SIGN}){_SIGN}|{_SIGN}\w")
_BEGINNINGS = ("that", "is")  # of a clause that is fitted to people and plurals


def texts_of_patterns(predicates: Mapping[str, Predicate]) -> frozenset[str]:
    """Return the texts that gloss patterns ask for, such as ``current`` in ``guide {1} back{2=current}``."""
    patterns = {*KNOWN_PATTERNS.values(), *(each.gloss for each in predicates.values())}
    alternatives = (each for pattern in patterns for each in read_pattern(pattern))
    values = (slot.value for each in alternatives for slot in each.slots if slot.value)
    return frozenset(str(Constant(value).value) for value in values)


def can_stand_in(text: str, of_patterns: frozenset[str]) -> bool:
    """Return whether a sign can stand for ``text`` in a gloss.

    It cannot for a class token, for a text that a pattern asks for (``of_patterns``), for one that looks like a part of
    a pattern or of a noun phrase, and for one that other words agree with: "an apple", "chips that are".
    """
    constant = Constant(text)
    return not (
        constant.value != text
        or constant.token_class
        or text in of_patterns
        or "_" in text
        or " of " in text
        or not text
        or text.split(" ", 1)[0] in _BEGINNINGS
        or text.endswith(PERSON)
        or looks_plural(text)
        or article(text) == "an"
    )


def is_loose(text: str) -> bool:
    """Return whether each sign in ``text`` stands apart, so that a text in its place joins no other word."""
    return not _TOUCHING.search(text)
