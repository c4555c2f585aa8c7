"""Write the signatures of a predicate as people read them: ``(object, room?)``, one a line.

``?`` marks arguments at the end that may be missing, so that the line above stands for two signatures.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from annotations.language.errors import LanguageError, Position
from annotations.language.predicates.signatures import ArgumentKind, Signature

MOST_ARGUMENTS = 20
_LINE = re.compile(r"\s*(?:\((?P<inside>[^()]*)\)|(?P<bare>[^()]*))\s*")


def print_signatures(signatures: Iterable[Signature]) -> str:
    """Return the lines that read back as the same signatures."""
    left = set(signatures)
    lines: list[tuple[tuple[str, ...], str]] = []
    while left:
        longest = max(left, key=lambda each: (len(each.arguments), each))
        kinds = longest.arguments
        least = len(kinds)
        while least and Signature(kinds[: least - 1]) in left:
            least -= 1
        left -= {Signature(kinds[:length]) for length in range(least, len(kinds) + 1)}
        words = [str(kind) + "?" * (place >= least) for place, kind in enumerate(kinds)]
        lines.append((kinds, f"({', '.join(words)})"))
    return "\n".join(line for _, line in sorted(lines))


def read_signatures(text: str) -> tuple[Signature, ...]:
    """Read what ``print_signatures`` writes; the parentheses may be missing around arguments.

    Raises:
        LanguageError: with the line, for an unknown kind or a misplaced question mark.
    """
    signatures: set[Signature] = set()
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip():
            signatures |= _read_line(line, Position("", number))
    return tuple(sorted(signatures))


def _read_line(line: str, place: Position) -> set[Signature]:
    match = _LINE.fullmatch(line)
    if match is None:
        raise LanguageError(
            f"line {place.line} is not a signature", place, "write (object, room?), one a line"
        )
    inside = match["inside"] if match["inside"] is not None else match["bare"]
    words = [word.strip() for word in inside.split(",")] if inside.strip() else []
    if len(words) > MOST_ARGUMENTS:
        raise LanguageError(
            f"line {place.line} has {len(words)} arguments", place, f"{MOST_ARGUMENTS} is the limit"
        )
    kinds = tuple(_kind(word.removesuffix("?").strip(), place) for word in words)
    optional = [word.endswith("?") for word in words]
    least = optional.index(True) if True in optional else len(words)
    if not all(optional[least:]):
        raise LanguageError(
            f"in line {place.line} an argument that may be missing is not at the end",
            place,
            "write a line for each way to use it",
        )
    return {Signature(kinds[:length]) for length in range(least, len(kinds) + 1)}


def _kind(word: str, place: Position) -> ArgumentKind:
    try:
        return ArgumentKind(word)
    except ValueError:
        raise LanguageError(
            f"there is no kind of argument {word[:40] or 'without a name'} (line {place.line})",
            place,
            f"the kinds are {', '.join(ArgumentKind)}",
        ) from None
