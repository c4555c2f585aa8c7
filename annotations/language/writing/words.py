"""Repairs for a word that has no place in a form or a pattern as it is written."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from annotations.language.errors import Edit
from annotations.language.grammar import Grammar
from annotations.language.symbols import (
    WILDCARD_NAMES,
    Nonterminal,
    Text,
    Wildcard,
    places_in_pattern,
    walk,
)
from annotations.language.templates import SemanticTemplate
from annotations.language.writing.candidates import (
    FORM,
    PATTERN,
    RepairCandidate,
    candidate,
    distance,
    insert,
    nearest,
    shorten,
)

_BARE = re.compile(r"[^\s(){}\",]+")
_NAMES = re.compile(r"[^\W\d][\w-]*(?: +[^\W\d][\w-]*)*")
_BOUND = re.compile(r"(λ|lambda\s)\s*(\$\d+)(?!\s*:?\s*[^\W\d])")
_BINDER = re.compile(r"\(\s*([^\s(){}$\"]*)\s*(\$\d+)\s*[:.]")


def in_form(form: str, pattern: str, offset: int) -> Iterator[RepairCandidate]:
    """Yield candidates for the word at ``offset`` of a form, where it is not allowed."""
    yield from _bare_word(form, pattern, offset)
    for match in _BOUND.finditer(form):
        yield candidate(f"Give {match[2]} the type e", [insert(FORM, match.end(), ":e")])
    for match in _BINDER.finditer(form):
        if match[1] not in ("λ", "lambda"):
            instead = f" for {match[1]}" if match[1] else f" before {match[2]}"
            edit = Edit(FORM, match.start(1), match.start(2), "λ")
            yield candidate(f"Write λ{instead}", [edit])
    commas = [match.start() for match in re.finditer(r',|"[^"]*"', form) if match.group() == ","]
    if commas:
        yield candidate("Remove the commas", [Edit(FORM, at, at + 1, " ") for at in commas], 0.5)


def _bare_word(form: str, pattern: str, offset: int) -> Iterator[RepairCandidate]:
    match = _BARE.match(form, offset)
    if match is None:
        return
    word = match.group()
    if re.fullmatch(r"[<⟨]\s*\w+\s*[>⟩]", word):
        text = f'"<{word[1:-1]}>"'
        yield candidate(f"Write {text}", [Edit(FORM, offset, match.end(), text)])
    names = _NAMES.match(form, offset)
    if names is None:
        return
    if form[names.end() : names.end() + 1] == '"':
        label = f'Open it: "{shorten(names.group())}"'
        yield candidate(label, [insert(FORM, offset, '"')])
    text = f'"{names.group()}"'
    yield candidate(f"Quote it: {shorten(text)}", [Edit(FORM, offset, names.end(), text)], 0.6)
    for place in places_in_pattern(pattern):
        rank = min(distance(word, name) for name in _names_of(place.slot))
        if rank <= 0.5:
            slot = pattern[place.start : place.end]
            yield candidate(f"Write {shorten(slot)}", [Edit(FORM, offset, match.end(), slot)], rank)


def _names_of(slot: Nonterminal | Wildcard) -> tuple[str, ...]:
    return (slot.name,) if isinstance(slot, Nonterminal) else (slot.name, slot.entity_class)


def wildcards(
    texts: Iterable[tuple[str, str]], source: str, offset: int
) -> Iterator[RepairCandidate]:
    """Yield candidates for a wildcard of an unknown kind or type around ``offset``, on every side.

    Args:
        texts: (source, text) of both sides.
        source: the side on which the wildcard cannot be read.
    """
    sides = dict(texts)
    around = next(
        (m for m in re.finditer(r"\{[^{}]*\}?", sides[source]) if m.start() <= offset <= m.end()),
        None,
    )
    if around is None:
        return
    kind = re.match(r"\{\s*(\w+)", around.group())
    if kind and kind[1].lower() not in WILDCARD_NAMES:
        for name, rank in nearest(kind[1], WILDCARD_NAMES):
            edits = [
                Edit(side, match.start(1), match.end(1), name)
                for side, text in sides.items()
                for match in re.finditer(rf"\{{\s*({re.escape(kind[1])})\b", text)
            ]
            yield candidate(f"Write {{{name}}}", edits, rank)
        return
    word = re.compile(r"\w+").match(sides[source], offset)
    if kind and word and word.end() <= around.end():
        start = len(sides[source][:offset].rstrip())
        label = f"Remove {word.group()} from the wildcard"
        yield candidate(label, [Edit(source, start, word.end(), "")], 0.5)


def in_pattern(pattern: str, offset: int) -> Iterator[RepairCandidate]:
    """Yield candidates for a bar, a dollar sign or a backslash that has nothing to stand for."""
    for match in re.finditer(r"\s*\|", pattern):
        if abs(match.start() - offset) <= 2 or abs(match.end() - offset) <= 2:
            edit = Edit(PATTERN, match.start(), match.end(), "")
            yield candidate("Remove the empty alternative", [edit], abs(match.end() - offset) / 10)
    if pattern[offset : offset + 1] in ("$", "\\"):
        mark = pattern[offset]
        yield candidate(f"Remove the {mark}", [Edit(PATTERN, offset, offset + 1, "")], 1.0)


def unheard(template: SemanticTemplate, grammar: Grammar) -> Iterator[RepairCandidate]:
    """Yield candidates for the words of a pattern that the grammar never says."""
    heard = {
        symbol.value
        for alternatives in grammar.rules.values()
        for alternative in alternatives
        for symbol in walk(alternative, notes=False)
        if isinstance(symbol, Text)
    }
    for match in re.finditer(r"\{[^}]*\}|\$\w+|[^\s(){}|,$]+", template.pattern_text):
        word = match.group()
        if word[0] in "{$" or word in heard:
            continue
        for name, rank in nearest(word, heard, 3):
            edit = Edit(PATTERN, match.start(), match.end(), name)
            yield candidate(f"Write “{name}” for “{shorten(word)}”", [edit], rank)
