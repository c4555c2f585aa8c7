"""Repairs for brackets and quotation marks of a text that cannot be read."""

from __future__ import annotations

import re
from collections.abc import Iterator

from annotations.language.errors import Edit
from annotations.language.writing.candidates import (
    FORM,
    RepairCandidate,
    candidate,
    insert,
    shorten,
)

MOST_PLACES = 80  # tried for one bracket
MOST_WORDS = 4  # that a quotation mark or a brace is closed after

_FORM_TOKEN = re.compile(r'"[^"]*"|\{[^{}]*\}|[()]|[^\s(){}"]+|["{}]')
_PATTERN_TOKEN = re.compile(r"\{[^{}]*\}|[()|]|(?:[^\s(){}|,\\]|\\.)+|[{},\\]")


def parentheses(text: str, source: str) -> Iterator[RepairCandidate]:
    """Yield candidates that add or remove one parenthesis, if the text has too many of one kind."""
    pattern = _FORM_TOKEN if source == FORM else _PATTERN_TOKEN
    tokens = list(pattern.finditer(text))[:MOST_PLACES]
    opening = [each for each in tokens if each.group() == "("]
    closing = [each for each in tokens if each.group() == ")"]
    missing = len(opening) - len(closing)
    if missing > 0:
        yield from _closings(text, source, tokens, missing)
        if missing == 1:
            yield from (_removal(each, source, 2.0) for each in opening)
    elif missing < 0:
        if missing == -1:
            yield from (_removal(each, source, 1.0) for each in reversed(closing))
        yield from _openings(source, tokens, -missing)


def _closings(
    text: str, source: str, tokens: list[re.Match[str]], missing: int
) -> Iterator[RepairCandidate]:
    """Close one parenthesis after each token, and the others at the end of the text."""
    end = len(text.rstrip())
    rest = [insert(source, end, ")" * (missing - 1))] * (missing > 1)
    label = "Close the parenthesis" if missing == 1 else f"Close {missing} parentheses"
    yield candidate(f"{label} at the end", [insert(source, end, ")" * missing)], 0.5)
    for token in reversed(tokens):
        if token.group() in ("(", "|") or token.end() == end:
            continue
        before = shorten(text[: token.end()].rstrip(")").rsplit("(", 1)[-1])
        yield candidate(
            f"Close the parenthesis after “{before}”",
            [insert(source, token.end(), ")"), *rest],
            1.0,
        )


def _openings(source: str, tokens: list[re.Match[str]], missing: int) -> Iterator[RepairCandidate]:
    for token in tokens:
        if token.group() not in (")", "|"):
            yield candidate(
                f"Open a parenthesis before “{shorten(token.group())}”",
                [insert(source, token.start(), "(" * missing)],
                1.0,
            )


def _removal(token: re.Match[str], source: str, rank: float) -> RepairCandidate:
    label = f"Remove the {token.group()} at character {token.start() + 1}"
    return candidate(label, [Edit(source, token.start(), token.end(), "")], rank)


def moved_parentheses(text: str, offset: int) -> Iterator[RepairCandidate]:
    """Yield candidates that move a ) from before ``offset`` to behind it: something was closed too early."""
    tokens = list(_FORM_TOKEN.finditer(text))[:MOST_PLACES]
    before = [each for each in tokens if each.group() == ")" and each.start() < offset]
    behind = [each for each in tokens if each.group() == ")" and each.start() > offset]
    for early in before[-3:]:
        for late in behind[:4]:
            edits = [Edit(FORM, early.start(), early.end(), ""), insert(FORM, late.end(), ")")]
            yield candidate("Close the λ later", edits, 0.45 + late.start() / 1e5)


def marks(text: str, source: str, offset: int) -> Iterator[RepairCandidate]:
    """Yield candidates that close, open or remove the quotation mark or brace at ``offset``."""
    mark = text[offset : offset + 1]
    closing = {'"': '"', "{": "}"}.get(mark)
    words = list(re.finditer(r'[^\s(){}"|]+', text))
    if closing:
        for number, word in enumerate([w for w in words if w.start() > offset][:MOST_WORDS]):
            inside = text[offset + 1 : word.end()]
            label = f"Close it: {mark}{shorten(inside)}{closing}"
            yield candidate(label, [insert(source, word.end(), closing)], number / 10)
    opening = {'"': '"', "}": "{"}.get(mark)
    if opening:
        behind = [w for w in words if w.end() <= offset][-MOST_WORDS:]
        for number, word in enumerate(reversed(behind)):
            inside = text[word.start() : offset]
            label = f"Open it: {opening}{shorten(inside)}{mark}"
            yield candidate(label, [insert(source, word.start(), opening)], number / 10 + 0.05)
    if closing or opening:
        yield candidate(f"Remove the {mark}", [Edit(source, offset, offset + 1, "")], 1.0)
