"""Replace parts of a text."""

from __future__ import annotations

from collections.abc import Iterable


def replace_parts(text: str, parts: Iterable[tuple[int, int]], new: str) -> str:
    """Return ``text`` with ``new`` for each part (start, end); the parts are in order and apart."""
    pieces: list[str] = []
    last = 0
    for start, end in parts:
        pieces += [text[last:start], new]
        last = end
    return "".join((*pieces, text[last:]))
