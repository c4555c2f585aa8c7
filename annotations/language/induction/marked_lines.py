"""Read and write commands as people give them for an example: what may change stands in brackets.

    water the [tomatoes] in [bed two]
    irrigate the [roses](plant) = water

A class may stand behind a mark, in parentheses, as in the training files of Rasa. Behind an equals sign stands what
the command means: the name of its predicate, or its whole form with the marked texts as constants. A comment can say
that two predicates, or the classes of two marks, are not one: ``# irrigate is not water``. Another one gives a
predicate its English: ``# water: give water to {1} | give water to {1} in {2}``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import TypeAlias

from annotations.language.forms import Form, read_form, require_token, to_template
from annotations.language.texts import (
    ARTICLES,
    ASKING_WORDS,
    CONDITIONAL_PHRASES,
    COURTESY_CLOSINGS,
    COURTESY_OPENINGS,
    MAX_ENTITY,
    MAX_GLOSS,
    MAX_PREDICATE,
    TITLES,
    LanguageError,
    Position,
    Problem,
    error_at,
    normalise_line,
    require_length,
    require_name,
)

MOST_LINES = 200
MOST_CHARACTERS = 500  # of one line
MOST_PARTS = 30  # words and marks of one line: what two lines share is found in time that grows with their product
EXAMPLE = "water the [tomatoes] in [bed two]"

_MARK = re.compile(r"\[(?P<text>[^\[\]]*)\](?:\((?P<token>[^()]*)\))?|[^\s\[\]]+|[\[\]]")
_WORD = re.compile(r"[^\s,.;:!?\"“”]+|,")
_NAME = re.compile(r"[a-z]\w*")
_APART = re.compile(r"#\s*(\[[^\[\]]+\]|\S+) is not (\[[^\[\]]+\]|\S+)\s*")
_ENGLISH = re.compile(r"#\s*([a-z]\w*)\s*:\s*(\S.*)")


@dataclass(frozen=True, slots=True)
class Mark:
    """What may change in a command; ``entity_class`` is empty where nobody has said it."""

    text: str
    entity_class: str = ""

    def __str__(self) -> str:
        return f"[{self.text}]({self.entity_class})" if self.entity_class else f"[{self.text}]"


Part: TypeAlias = "str | Mark"


@dataclass(frozen=True, slots=True)
class Example:
    """A command: its words and marks in order, without what is said out of courtesy, and what it means.

    ``action`` is the name of its predicate and ``form`` its whole form; both are empty where nobody has said so.
    ``line`` counts from 1. ``said`` is the command as it was written, without what was marked and meant.
    """

    parts: tuple[Part, ...]
    action: str = ""
    form: Form | None = None
    line: int = 1
    said: str = field(default="", compare=False)

    @property
    def marks(self) -> tuple[Mark, ...]:
        return tuple(part for part in self.parts if isinstance(part, Mark))

    @property
    def text(self) -> str:
        """The command as one says it."""
        return text_of(self.parts)

    def __str__(self) -> str:
        meaning = to_template(self.form) if self.form is not None else self.action
        said = " ".join(map(str, self.parts)).replace(" ,", ",")
        return f"{said} = {meaning}" if meaning else said


def text_of(parts: Iterable[Part]) -> str:
    """Return the parts of a command as one says them."""
    words = (part.text if isinstance(part, Mark) else part for part in parts)
    return " ".join(words).replace(" ,", ",")


def read_examples(text: str) -> tuple[tuple[Example, ...], tuple[Problem, ...]]:
    """Read the lines of a text. Empty ones and comments (``#``) are left out, equal ones are read once.

    Returns:
        The examples, and what is wrong with the lines that are none.
    """
    examples: dict[str, Example] = {}
    problems: list[Problem] = []
    lines = text.splitlines()
    for number, line in enumerate(lines[:MOST_LINES], start=1):
        if line.strip() and not line.lstrip().startswith("#"):
            try:
                example = read_example(line, Position(line=number))
            except LanguageError as error:
                problems.append(error.problem)
            else:
                examples.setdefault(str(example), example)
    if len(lines) > MOST_LINES:
        place = Position(line=MOST_LINES + 1)
        message, hint = (
            f"there are {len(lines):,} lines",
            f"{MOST_LINES} are the limit; store these",
        )
        problems.append(error_at(place, message, hint))
    return tuple(examples.values()), tuple(problems)


def read_example(line: str, position: Position | None = None) -> Example:
    """Read one line.

    Raises:
        LanguageError: a bracket without its partner, an empty mark, a class that is no token, a meaning that is neither
            a name nor a form, or nothing that is said.
    """
    place = position or Position()
    require_length(line, "line", MOST_CHARACTERS, place)
    line = normalise_line(line)
    said, equals, meaning = line.partition(" = ")
    parts = tuple(_with_titles(_without_articles(_parts(said, place))))
    if all(part == "," for part in parts):
        raise LanguageError("the line says nothing", place, f"write a command, as in: {EXAMPLE}")
    if len(parts) > MOST_PARTS:
        raise LanguageError(
            f"the line has {len(parts):,} words and marks", place, f"{MOST_PARTS} is the limit"
        )
    if not equals:
        _require_command(_without_courtesy(parts), place)
    written = _MARK.sub(lambda match: match[0] if match["text"] is None else match["text"], said)
    example = Example(_without_courtesy(parts), line=place.line, said=" ".join(written.split()))
    return (
        _with_meaning(example, meaning.strip(), place.shifted(len(said) + 3)) if equals else example
    )


def _parts(said: str, place: Position) -> Iterator[Part]:
    for match in _MARK.finditer(said):
        here = place.shifted(match.start())
        if match["text"] is not None:
            text, token = " ".join(match["text"].split()), (match["token"] or "").strip()
            if not text:
                raise LanguageError("the brackets are empty", here, "write what may change in them")
            require_length(text, "text of a mark", MAX_ENTITY, here)
            if token:
                _require_class(token, here)
            yield Mark(text, token)
        elif match[0] in "[]":
            raise LanguageError(
                "a bracket has no partner", here, f"mark what may change, as in: {EXAMPLE}"
            )
        else:
            for word in _WORD.findall(match[0]):
                if word[0] in "<$":  # what a slot and a nonterminal begin with
                    raise LanguageError(
                        f"“{word[:40]}” is no word of a command", here, "write it without < and $"
                    )
                yield word


def _without_articles(parts: Iterable[Part]) -> Iterator[Part]:
    """Yield the parts with the article of a mark before it: the [dry dock]. So things are called by their names."""
    for part in parts:
        if isinstance(part, Mark):
            *before, last = part.text.split()
            articles = list(takewhile(ARTICLES.__contains__, before))
            yield from articles
            part = replace(part, text=" ".join([*before[len(articles) :], last]))
        yield part


def _with_titles(parts: Iterable[Part]) -> Iterator[Part]:
    """Yield the parts with a title inside the mark of the name behind it: ``the doctor [Brandt]``."""
    title = ""
    for part in parts:
        if isinstance(part, Mark) and title:
            has_name = part.text[0].isupper()
            if not has_name:
                yield title
            part = replace(part, text=f"{title} {part.text}") if has_name else part
            title = ""
        elif title:
            yield title
            title = ""
        if isinstance(part, str) and part.casefold() in TITLES:
            title = part
        else:
            yield part
    if title:
        yield title


def _require_class(token: str, place: Position) -> None:
    try:
        require_token(token)
    except LanguageError as error:
        raise LanguageError(error.message, place, error.hint) from None


def _require_command(parts: tuple[Part, ...], place: Position) -> None:
    """Raise LanguageError for what forbids something, or asks for it under a condition: neither is done at once."""
    words = [part.lower() if isinstance(part, str) else "" for part in parts]
    said = f" {' '.join(words)} "
    has_if = "if" in words and ASKING_WORDS.isdisjoint(words)  # "check if …" asks for no condition
    has_phrase = any(f" {each} " in said for each in CONDITIONAL_PHRASES)
    hint = "write what to do at once, or behind an equals sign one name for all of it"
    if words[0] in _FORBIDDING or words[:2] == ["do", "not"]:
        raise LanguageError("the line says what not to do", place, hint)
    if words[0] in _CONDITIONS or has_if or has_phrase:
        raise LanguageError("the line asks for something under a condition", place, hint)


_FORBIDDING = frozenset(("don't", "dont", "never", "not"))
_CONDITIONS = frozenset(("if", "when", "while", "once"))


def _with_meaning(example: Example, meaning: str, place: Position) -> Example:
    if meaning.startswith("("):
        return replace(example, form=read_form(meaning, place))
    if not _NAME.fullmatch(meaning):
        raise LanguageError(
            f"{meaning[:40] or 'nothing'} is no name of what to do",
            place,
            "write one word behind the equals sign, such as water, or a form in parentheses",
        )
    require_name(meaning, "predicate", MAX_PREDICATE, place)
    return replace(example, action=meaning)


_OPENINGS, _CLOSINGS = (
    sorted((phrase.split() for phrase in phrases), key=len, reverse=True)
    for phrases in (COURTESY_OPENINGS, COURTESY_CLOSINGS)
)


def _without_courtesy(parts: tuple[Part, ...]) -> tuple[Part, ...]:
    """Return the parts without "please" and the like around them; all where nothing else is said."""
    left = list(parts)
    while phrase := _at_end(left, _OPENINGS, begins=True):
        left = left[len(phrase) :]
    while phrase := _at_end(left, _CLOSINGS, begins=False):
        left = left[: -len(phrase)]
    if left and isinstance(left[0], str) and left[0] != "I" and left[0].istitle():
        left[0] = left[0].lower()
    return tuple(left) or parts


def _at_end(parts: list[Part], phrases: Iterable[list[str]], begins: bool) -> list[str]:
    """Return the phrase that ``parts`` begin or end with, or the comma there; empty where there is none."""
    for phrase in ([","], *phrases):
        there = parts[: len(phrase)] if begins else parts[-len(phrase) :]
        if [each.lower() if isinstance(each, str) else each for each in there] == phrase:
            return phrase
    return []


def rewritten(text: str, change: Callable[[Example], Example]) -> str:
    """Return a text of lines with those changed whose example ``change`` makes another; all others stay as they are."""
    lines = text.splitlines()
    for number, line in enumerate(lines):
        try:
            example = read_example(line, Position(line=number + 1))
        except LanguageError:
            continue
        changed = change(example)
        if changed != example:
            lines[number] = str(changed)
    return "\n".join(lines)


def said_apart(text: str) -> frozenset[frozenset[str]]:
    """Return the pairs of names, and of marked texts in their brackets, that a text says are not one."""
    found = map(_APART.fullmatch, map(str.strip, text.splitlines()))
    return frozenset(frozenset(match.groups()) for match in found if match)


def said_english(text: str) -> dict[str, tuple[str, int]]:
    """Return name → the gloss pattern that a comment gives it, and its line; the last one counts."""
    found: dict[str, tuple[str, int]] = {}
    for number, line in enumerate(text.splitlines()[:MOST_LINES], start=1):
        if match := _ENGLISH.fullmatch(normalise_line(line)):
            found[match[1]] = match[2], number
    return found


def with_english(text: str, name: str, gloss: str) -> str:
    """Return the lines with a comment that gives the predicate ``name`` a gloss pattern; without one where it is empty.

    Raises LanguageError where it is too long to store.
    """
    require_length(gloss := normalise_line(gloss), "English sentence", MAX_GLOSS, Position())
    comment = f"# {name}: {gloss}" if gloss else ""
    lines = text.splitlines()
    if (known := said_english(text).get(name)) is not None:
        lines[known[1] - 1 : known[1]] = filter(None, [comment])
        return "\n".join(lines)
    return "\n".join(filter(None, [text.rstrip(), comment]))
