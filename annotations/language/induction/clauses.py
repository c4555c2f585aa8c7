"""One command after another in one line: each is an example of its own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from annotations.language.induction.marked_lines import Example, Mark, Part
from annotations.language.texts import BOUNDARIES, DETERMINERS, JOINTS

# What stands for the thing that was named before: "take the hose and bring it to the shed".
_STAND_FOR_LAST = frozenset(("it", "them", "him", "her"))
_PHRASES = sorted((phrase.split() for phrase in JOINTS), key=len, reverse=True)


def clauses_of(example: Example) -> tuple[tuple[Part, ...], ...]:
    """Return the commands of a line, in order. A pronoun becomes what was marked last before its command.

    A line whose meaning somebody has said is one command.
    """
    if example.action or example.form is not None:
        return (example.parts,)
    clauses: list[tuple[Part, ...]] = []
    last: Sequence[Part] = ()
    for clause in _cut(example.parts):
        full = tuple(_with_antecedent(clause, last)) if last else clause
        clauses.append(full)
        last = _noun_phrase(full) or last
    return tuple(clauses)


def names_all(example: Example) -> bool:
    """Return whether a line says each of its commands in full: no word stands for what was named before."""
    return not any(
        isinstance(each, str) and each.lower() in _STAND_FOR_LAST for each in example.parts
    )


def _cut(parts: tuple[Part, ...]) -> Iterator[tuple[Part, ...]]:
    start = place = 0
    is_command = bool(parts) and _is_verb(parts, 0)
    while place < len(parts):
        length = _joint(parts, place) if place > start else 0
        if length and _is_verb(parts, place + length):
            if is_command:  # "in bed two, water the roses" begins with none
                yield parts[start:place]
                start = place + length
            is_command = True
            place += length
        else:
            place += 1
    yield parts[start:]


def _joint(parts: Sequence[Part], place: int) -> int:
    """Return how many parts join two commands at a place: a comma, a phrase such as "and then", or both."""
    comma = parts[place] == ","
    start = place + comma
    for phrase in _PHRASES:
        there = parts[start : start + len(phrase)]
        if [each.lower() if isinstance(each, str) else each for each in there] == phrase:
            return comma + len(phrase)
    return int(comma)


def _is_verb(parts: Sequence[Part], place: int) -> bool:
    """Return whether a command can begin at a place: with a word that begins no phrase of another kind."""
    word = parts[place] if place < len(parts) else ","
    return (
        isinstance(word, str)
        and word.lower() not in DETERMINERS
        and word.lower() not in BOUNDARIES
        and word != ","
    )


def _with_antecedent(clause: Sequence[Part], last: Sequence[Part]) -> Iterator[Part]:
    for part in clause:
        if isinstance(part, str) and part.lower() in _STAND_FOR_LAST:
            yield from last
        else:
            yield part


def _noun_phrase(clause: Sequence[Part]) -> Sequence[Part]:
    """Return the first mark of a command with its article; empty without a mark."""
    for place, part in enumerate(clause):
        if isinstance(part, Mark):
            before = clause[place - 1] if place else ""
            has_article = isinstance(before, str) and before.lower() in DETERMINERS
            return clause[place - 1 : place + 1] if has_article else (part,)
    return ()
