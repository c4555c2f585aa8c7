"""Roles of slots in a form, and contexts of mentions in a command: what evidence is counted by."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from annotations.language.forms import (
    CONJUNCTION,
    NAMING,
    NOUN,
    PERSON,
    PERSON_CLASS,
    PERSONAL_WORDS,
    THING,
    THING_CLASS,
    Application,
    Constant,
    Form,
    Variable,
    children,
)
from annotations.language.texts import DETERMINERS, GOING_WORDS, PERSON_WORDS, THING_WORDS

SlotPath = tuple[int, ...]
_WORD = re.compile(r"<\w+>|\w+(?:'\w+)?|[^\w\s]")
_TOKEN = re.compile(r"<([^\W\d]+?)(\d*)>")


@dataclass(frozen=True, slots=True)
class Context:
    """How a mention stands in its command: the word before it, and the kind named last before it."""

    cue: str
    neighbour: str


@dataclass(frozen=True, slots=True)
class SlotRole:
    """The way to a slot: ``exact`` through all predicates, ``similar`` by the last of them alone."""

    exact: str
    similar: str


def words_of(text: str) -> list[str]:
    """Return the words, class tokens and signs of a text, in lower case."""
    return [word.casefold() for word in _WORD.findall(text)]


def class_of(word: str) -> str:
    """Return ``location`` for ``<location>`` and ``<location1>``; empty for any other word."""
    match = _TOKEN.fullmatch(word)
    return match[1] if match else ""


def context_of(words: Sequence[str], place: int) -> Context:
    """Return the context of the word at ``place``."""
    before = [word for word in words[:place] if word not in DETERMINERS or word in PERSON_WORDS]
    verb, cue = ["", "", *before][-2:]
    if cue == "to" and verb in GOING_WORDS:
        cue = "go to"
    # A person or a thing that is not named counts as one of that class.
    kinds = (
        PERSON_CLASS
        if word in PERSON_WORDS
        else THING_CLASS
        if word in THING_WORDS
        else class_of(word)
        for word in reversed(before)
    )
    return Context("<>" if class_of(cue) else cue, next(filter(None, kinds), ""))


def role_of(form: Form, path: SlotPath) -> SlotRole:
    """Return the role of the slot at ``path``."""
    exact: list[str] = []
    similar, outermost = "", 0
    is_person = False
    for place in path:
        parts = children(form)
        if any(isinstance(each, Application) and _describes(each) for each in parts):
            is_person = any(
                isinstance(each, Application) and each.predicate in PERSONAL_WORDS for each in parts
            )
        if isinstance(form, Application):
            name = str(form.predicate)
            exact.append(f"{name}.{place + 1}")
            if _describes(form):
                similar = f"{name} of a {PERSON if is_person else THING}"
            elif not _joins(form):
                similar = f"argument {min(place, 1) + 1}"
            if not outermost and not _joins(form):
                outermost = place + 1
        form = parts[place]
    if similar.startswith((NOUN, NAMING)):
        similar = f"{similar} in argument {outermost}"
    return SlotRole("/".join(exact), similar)


def tokens_of(form: Form, path: SlotPath = ()) -> Iterator[tuple[SlotPath, str]]:
    """Yield the class tokens of a form with the ways to them, in order."""
    if isinstance(form, Constant) and form.token_class:
        yield path, str(form.value)
    for place, child in enumerate(children(form)):
        yield from tokens_of(child, (*path, place))


def _describes(form: Application) -> bool:
    return isinstance(next(iter(form.arguments), None), Variable)


def _joins(form: Application) -> bool:
    """Return whether a form joins others, which gives no role: a conjunction, or actions in sequence."""
    parts = [each for each in form.arguments if isinstance(each, Application)]
    is_joined = len(parts) == len(form.arguments) > 1
    return form.predicate == CONJUNCTION or (is_joined and not all(map(_describes, parts)))
