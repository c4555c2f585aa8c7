"""Repairs for a pattern or a form that cannot be read: its words, brackets and quotation marks."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from annotations.language.forms import (
    EntityClasses,
    Text,
    Wildcard,
    places_in_pattern,
    walk_symbols,
    wildcard_names,
)
from annotations.language.grammar import Grammar
from annotations.language.templates.candidates import (
    FORM,
    PATTERN,
    RepairCandidate,
    candidate,
    distance,
    insert,
    nearest,
    shorten,
)
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import TextEdit

_BARE = re.compile(r"[^\s(){}\",]+")
_NAMES = re.compile(r"[^\W\d][\w-]*(?: +[^\W\d][\w-]*)*")
_BOUND = re.compile(r"(λ|lambda\s)\s*+(\$\d++)(?!\s*+(?::\s*+)?[^\W\d])")
_BINDER = re.compile(r"\(\s*+([^\s(){}$\"]*+)\s*+(\$\d++)\s*+[:.]")
_SINGLE = "‘’‚‛‹›`´"
_CURLY = re.compile(f"[“”„‟«»{_SINGLE}]")
MOST_PLACES = 80  # tried for one bracket
MOST_WORDS = 4  # that a quotation mark or a brace is closed after

_FORM_TOKEN = re.compile(r'"[^"]*"|\{[^{}]*\}|[()]|[^\s(){}"]+|["{}]')
_PATTERN_TOKEN = re.compile(r"\{[^{}]*\}|[()|]|(?:[^\s(){}|,\\]|\\.)+|[{},\\]")


def in_form(form: str, pattern: str, offset: int) -> Iterator[RepairCandidate]:
    """Yield candidates for the word at ``offset`` of a form, where it is not allowed."""
    yield from _bare_word(form, pattern, offset)
    for match in _BOUND.finditer(form):
        yield candidate(f"Give {match[2]} the type e", [insert(FORM, match.end(), ":e")])
    for match in _BINDER.finditer(form):
        if match[1] not in ("λ", "lambda"):
            instead = f" for {match[1]}" if match[1] else f" before {match[2]}"
            edit = TextEdit(FORM, match.start(1), match.start(2), "λ")
            yield candidate(f"Write λ{instead}", [edit])
    commas = [match.start() for match in re.finditer(r',|"[^"]*"', form) if match.group() == ","]
    if commas:
        yield candidate(
            "Remove the commas", [TextEdit(FORM, at, at + 1, " ") for at in commas], 0.5
        )


def _bare_word(form: str, pattern: str, offset: int) -> Iterator[RepairCandidate]:
    match = _BARE.match(form, offset)
    if match is None:
        return
    word = match.group()
    if re.fullmatch(r"[<⟨]\s*\w+\s*[>⟩]", word):
        text = f'"<{word[1:-1]}>"'
        yield candidate(f"Write {text}", [TextEdit(FORM, offset, match.end(), text)])
    names = _NAMES.match(form, offset)
    if names is None:
        return
    if form[names.end() : names.end() + 1] == '"':
        label = f'Open it: "{shorten(names.group())}"'
        yield candidate(label, [insert(FORM, offset, '"')])
    text = f'"{names.group()}"'
    yield candidate(f"Quote it: {shorten(text)}", [TextEdit(FORM, offset, names.end(), text)], 0.6)
    for place in places_in_pattern(pattern):
        names_of_slot = [place.slot.name]
        if isinstance(place.slot, Wildcard):
            names_of_slot.append(place.slot.entity_class)
        rank = min(distance(word, name) for name in names_of_slot)
        if rank <= 0.5:
            slot = pattern[place.start : place.end]
            yield candidate(
                f"Write {shorten(slot)}", [TextEdit(FORM, offset, match.end(), slot)], rank
            )


def plain_quotes(text: str) -> Iterator[RepairCandidate]:
    """Yield candidates that write plain quotation marks into a pattern for those of word processors, or remove them."""
    marks = list(_CURLY.finditer(text))
    if not marks:
        return

    def write(single: str, double: str) -> list[TextEdit]:
        return [
            TextEdit(PATTERN, each.start(), each.end(), single if each[0] in _SINGLE else double)
            for each in marks
        ]

    yield candidate("Write plain quotation marks", write("'", '"'))
    yield candidate("Remove the quotation marks", write("'", ""), 0.1)


def wildcards(
    texts: Iterable[tuple[str, str]], source: str, offset: int, classes: EntityClasses
) -> Iterator[RepairCandidate]:
    """Yield candidates for a wildcard of an unknown kind or type around ``offset``, on every side.

    Args:
        texts: (source, text) of both sides.
        source: the side on which the wildcard cannot be read.
        classes: those that wildcards may be of.
    """
    sides = dict(texts)
    around = next(
        (m for m in re.finditer(r"\{[^{}]*\}?", sides[source]) if m.start() <= offset <= m.end()),
        None,
    )
    if around is None:
        return
    kind = re.match(r"\{\s*(\w+)", around.group())
    names = wildcard_names(classes)
    if kind and kind[1].lower() not in names:
        for name, rank in nearest(kind[1], names):
            edits = [
                TextEdit(side, match.start(1), match.end(1), name)
                for side, text in sides.items()
                for match in re.finditer(rf"\{{\s*({re.escape(kind[1])})\b", text)
            ]
            yield candidate(f"Write {{{name}}}", edits, rank)
        return
    word = re.compile(r"\w+").match(sides[source], offset)
    if kind and word and word.end() <= around.end():
        start = len(sides[source][:offset].rstrip())
        label = f"Remove {word.group()} from the wildcard"
        yield candidate(label, [TextEdit(source, start, word.end(), "")], 0.5)


def in_pattern(pattern: str, offset: int) -> Iterator[RepairCandidate]:
    """Yield candidates for a bar, a dollar sign or a backslash that has nothing to stand for."""
    for match in re.finditer(r"(?<!\s)\s*+\|", pattern):
        if abs(match.start() - offset) <= 2 or abs(match.end() - offset) <= 2:
            edit = TextEdit(PATTERN, match.start(), match.end(), "")
            yield candidate("Remove the empty alternative", [edit], abs(match.end() - offset) / 10)
    if pattern[offset : offset + 1] in ("$", "\\"):
        mark = pattern[offset]
        yield candidate(f"Remove the {mark}", [TextEdit(PATTERN, offset, offset + 1, "")], 1.0)


def unheard(template: SemanticTemplate, grammar: Grammar) -> Iterator[RepairCandidate]:
    """Yield candidates for the words of a pattern that the grammar never says."""
    heard = {
        symbol.value
        for alternatives in grammar.rules.values()
        for alternative in alternatives
        for symbol in walk_symbols(alternative, notes=False)
        if isinstance(symbol, Text)
    }
    for match in re.finditer(r"\{[^}]*+(?:\}|\Z)|\$\w+|[^\s(){}|,$]+", template.pattern_text):
        word = match.group()
        if word[0] in "{$" or word in heard or word == "->":
            continue
        for name, rank in nearest(word, heard, 3):
            edit = TextEdit(PATTERN, match.start(), match.end(), name)
            yield candidate(f"Write “{name}” for “{shorten(word)}”", [edit], rank)


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
        for token in tokens:
            if token.group() not in (")", "|"):
                yield candidate(
                    f"Open a parenthesis before “{shorten(token.group())}”",
                    [insert(source, token.start(), "(" * (-missing))],
                    1.0,
                )


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


def _removal(token: re.Match[str], source: str, rank: float) -> RepairCandidate:
    label = f"Remove the {token.group()} at character {token.start() + 1}"
    return candidate(label, [TextEdit(source, token.start(), token.end(), "")], rank)


def moved_parentheses(text: str, offset: int) -> Iterator[RepairCandidate]:
    """Yield candidates that move a ) from before ``offset`` to behind it: something was closed too early."""
    tokens = list(_FORM_TOKEN.finditer(text))[:MOST_PLACES]
    before = [each for each in tokens if each.group() == ")" and each.start() < offset]
    behind = [each for each in tokens if each.group() == ")" and each.start() > offset]
    for early in before[-3:]:
        for late in behind[:4]:
            edits = [TextEdit(FORM, early.start(), early.end(), ""), insert(FORM, late.end(), ")")]
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
        yield candidate(f"Remove the {mark}", [TextEdit(source, offset, offset + 1, "")], 1.0)
