"""Forms and commands as pages show them: three notations, an English sentence, chips, differences."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from annotations.language.canonical import canonicalize
from annotations.language.difference import Change, diff
from annotations.language.errors import LanguageError
from annotations.language.form_printing import to_corpus, to_reading, to_template
from annotations.language.logic import Form, read_form
from annotations.language.predicates import gloss
from annotations.language.symbols import ENTITY_CLASSES
from annotations.language.wildcards import read_wildcard
from annotations.models import World
from annotations.reading import predicates_of

CLASS_TOKEN = re.compile(rf"<({'|'.join(ENTITY_CLASSES)})(\d*)>")


@dataclass(frozen=True, slots=True)
class ShownForm:
    """A form in its three notations; a text that is no form stands as it is, with the others empty."""

    reading: str
    corpus: str = ""
    template: str = ""
    gloss: str = ""


@dataclass(frozen=True, slots=True)
class Piece:
    """A stretch of a command: words, or one class token (``text`` is as written)."""

    text: str
    entity_class: str = ""


@lru_cache(maxsize=8192)
def form_of(text: str) -> Form | None:
    """The form that ``text`` spells, None where it spells none."""
    try:
        return read_form(text)
    except LanguageError:
        return None


@lru_cache(maxsize=8192)
def shown(text: str) -> ShownForm:
    """``text`` (any notation) in all three notations, without a gloss."""
    form = form_of(text)
    if form is None:
        return ShownForm(reading=text)
    return ShownForm(to_reading(form), to_corpus(form), to_template(form))


def gloss_of(world: World, form: Form) -> str:
    """``form`` as an English sentence, said as the world's predicates are."""
    if not hasattr(world, "declared"):  # one query a page, however many forms it shows
        world.declared = predicates_of(world)
    return gloss(form, world.declared)


@lru_cache(maxsize=8192)
def pieces_of(command: str) -> tuple[Piece, ...]:
    """``command`` cut at its class tokens; the texts together are the command again."""
    pieces, end = [], 0
    for token in CLASS_TOKEN.finditer(command):
        if token.start() > end:
            pieces.append(Piece(command[end : token.start()]))
        pieces.append(Piece(token[0], token[1]))
        end = token.end()
    return (*pieces, Piece(command[end:])) if end < len(command) else tuple(pieces)


@lru_cache(maxsize=1024)
def wildcard_class(text: str) -> str:
    """The entity class of a wildcard as written, ``{placement 1}`` for one; empty where it has none."""
    try:
        return read_wildcard(text).entity_class
    except LanguageError:
        return ""


def difference(
    expected: str, predicted: str
) -> tuple[list[tuple[str, str]], list[tuple[str, str]]]:
    """Both forms in reading notation as (change, text), what only one has marked.

    Where one of them is no form there is nothing to compare, and both stand unmarked.
    """
    left, right = form_of(expected), form_of(predicted)
    if left is None or right is None:
        return unmarked(expected), unmarked(predicted)
    found = diff(left, right)
    return (
        [(str(span.change), span.text) for span in found.left_spans()],
        [(str(span.change), span.text) for span in found.right_spans()],
    )


def unmarked(text: str) -> list[tuple[str, str]]:
    form = form_of(text)
    return [(str(Change.SAME), to_reading(canonicalize(form)) if form else text)]
