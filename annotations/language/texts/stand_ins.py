"""Signs that stand in for texts, so that a sentence can be made once and filled with many texts.

A text has one sign for itself and one for its plural. They are characters that Unicode leaves to private use.
"""

from __future__ import annotations

import re

MOST_STAND_INS = 100  # texts
_FIRST = 0xF0000


def stand_in(number: int, is_plural: bool = False) -> str:
    """Return the sign for text ``number``, which counts from 0 to ``MOST_STAND_INS`` - 1."""
    return chr(_FIRST + 2 * number + is_plural)


STAND_IN = re.compile(f"[{stand_in(0)}-{stand_in(MOST_STAND_INS - 1, True)}]")


def read_stand_in(sign: str) -> tuple[int, bool]:
    """Return the number of the text that a sign stands for, and whether for its plural."""
    number, is_plural = divmod(ord(sign) - _FIRST, 2)
    return number, bool(is_plural)
