"""Prepare forms and commands for pages: three notations, an English sentence, chips, differences."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from rapidfuzz.distance import Indel

from annotations.language.forms import (
    Application,
    Change,
    Constant,
    Difference,
    Form,
    Lambda,
    Variable,
    canonicalize,
    children,
    diff,
    diff_unordered,
    read_template_form,
    read_wildcard,
    to_corpus,
    to_reading,
    to_template,
)
from annotations.language.texts import LanguageError
from annotations.language.world import gloss
from annotations.models import World
from annotations.rows.from_rows import classes_of, predicates_of

CLASS_TOKEN = re.compile(r"<([a-z][a-z_]*+)(\d*+)>")


@dataclass(frozen=True, slots=True)
class ShownForm:
    """A form in its three notations. A text that is not a form is its own reading; the others are empty."""

    reading: str
    corpus: str = ""
    template: str = ""
    gloss: str = ""


@dataclass(frozen=True, slots=True)
class Piece:
    """A part of a command: words, or one class token (``text`` is as written)."""

    text: str
    entity_class: str = ""


@lru_cache(maxsize=8192)
def form_of(text: str) -> Form | None:
    """Read ``text`` (any notation) as a form; None where it is not one."""
    try:
        return read_template_form(text)
    except LanguageError:
        return None


@lru_cache(maxsize=8192)
def shown(text: str) -> ShownForm:
    """Write ``text`` (any notation) in all three notations, without a gloss."""
    form = form_of(text)
    if form is None:
        return ShownForm(reading=text)
    return ShownForm(to_reading(form), to_corpus(form), to_template(form))


def gloss_of(world: World, form: Form, named: Mapping[str, str] | None = None) -> str:
    """Write ``form`` as an English sentence, with the glosses of the world's predicates.

    ``named`` gives the classes of texts in it that name entities.
    """
    if not hasattr(world, "declared"):  # one query a page, however many forms it shows
        world.declared = predicates_of(world)
        world.classes = classes_of(world)
    return gloss(form, world.declared, world.classes, named)


@lru_cache(maxsize=8192)
def pieces_of(command: str) -> tuple[Piece, ...]:
    """Cut ``command`` at its class tokens; the texts together are the command again."""
    pieces, end = [], 0
    for token in CLASS_TOKEN.finditer(command):
        if token.start() > end:
            pieces.append(Piece(command[end : token.start()]))
        pieces.append(Piece(token[0], token[1]))
        end = token.end()
    return (*pieces, Piece(command[end:])) if end < len(command) else tuple(pieces)


@lru_cache(maxsize=1024)
def wildcard_class(text: str) -> str:
    """Return the entity class of a wildcard such as ``{placement 1}``; empty where it has none."""
    try:
        return read_wildcard(text).entity_class
    except LanguageError:
        return ""


def difference(
    expected: str, predicted: str
) -> tuple[list[tuple[str, str]], list[tuple[str, str]]]:
    """Return both forms in reading notation as lists of (change, text).

    Where one of them is not a form there is nothing to compare, and both are unmarked.
    """
    left, right = form_of(expected), form_of(predicted)
    if left is None or right is None:
        return unmarked(expected), unmarked(predicted)
    changes = diff(left, right)
    return (
        [(str(span.change), span.text) for span in changes.left_spans()],
        [(str(span.change), span.text) for span in changes.right_spans()],
    )


@lru_cache(maxsize=8192)
def answer_difference(annotated: str, answer: str) -> Difference | None:
    """Return what an answer has wrong, whatever the order of conjuncts; None where one of them is no form."""
    left, right = form_of(annotated), form_of(answer)
    return None if left is None or right is None else diff_unordered(left, right)


def answer_pieces(
    annotated: str, answer: str
) -> tuple[list[tuple[str, str]], list[tuple[str, str]]]:
    """Return what ``difference`` does, whatever the order of conjuncts: those of the answer stand in the order
    of the label."""
    compared = answer_difference(annotated, answer)
    if compared is None:
        return unmarked(annotated), unmarked(answer)
    return (
        [(str(span.change), span.text) for span in compared.left_spans()],
        [(str(span.change), span.text) for span in compared.right_spans()],
    )


def tree_of(node: Difference) -> dict[str, Any]:
    """Return two forms as one tree of plain values: label, kind and change of each node, its children.

    A node that is replaced shows both labels; a subtree that only one form has is marked whole.
    """
    form = node.left if node.right is None else node.right
    assert form is not None  # a node is of at least one of the two
    label, kind = _node(form)
    if node.change is Change.CHANGED and node.left is not None and node.right is not None:
        label = f"{_node(node.left)[0]} → {label}"
    below = node.children or tuple(
        Difference(node.change, None, child, 0) for child in children(form)
    )
    return {
        "label": label,
        "kind": kind,
        "change": str(node.change),
        "children": [tree_of(child) for child in below],
    }


def _node(form: Form) -> tuple[str, str]:
    """Return what a node of a tree is labelled with, and what it is."""
    if isinstance(form, Lambda):
        return f"λ${form.variable}", "lambda"
    if isinstance(form, Application):
        return str(form.predicate), "predicate"
    if isinstance(form, Variable):
        return f"${form.index}", "variable"
    return (
        (str(form.value), "constant") if isinstance(form, Constant) else (to_corpus(form), "name")
    )


# A text in pieces: what happened to each (a ``Change``), and its words.
Pieces = list[tuple[str, str]]
WORDS = re.compile(r"\s+|\w+|[^\w\s]")
TOKENS = re.compile(r"\s+|<\w+>|\w+|[^\w\s]")  # a class token is a word
MOST_WORDS = 4_000  # of two texts together whose words are compared: quadratic, a few milliseconds


def compare(old: str, new: str, is_form: bool = False) -> tuple[Pieces, Pieces]:
    """Return both texts with what is removed from ``old`` and added in ``new`` marked.

    Forms are compared as trees where both can be read, everything else word by word.
    """
    if is_form and old and new and form_of(old) and form_of(new):
        return difference(old, new)
    left, right = WORDS.findall(old), WORDS.findall(new)
    if len(left) + len(right) > MOST_WORDS:
        return [(str(Change.REMOVED), old)], [(str(Change.ADDED), new)]
    steps = Indel.opcodes(left, right)
    return (
        _pieces(
            Change.REMOVED, ((step.tag, left[step.src_start : step.src_end]) for step in steps)
        ),
        _pieces(
            Change.ADDED, ((step.tag, right[step.dest_start : step.dest_end]) for step in steps)
        ),
    )


def merge_words(old: str, new: str) -> Pieces:
    """Return one text with what is removed from ``old`` and added in ``new`` marked, word by word."""
    left, right = TOKENS.findall(old), TOKENS.findall(new)
    if len(left) + len(right) > MOST_WORDS:
        return [(str(Change.REMOVED), old), (str(Change.ADDED), new)]
    pieces: Pieces = []
    steps = Indel.opcodes(left, right)
    for step in steps:
        before = "".join(left[step.src_start : step.src_end])
        if step.tag == "equal":
            pieces.append((str(Change.SAME), before))
            continue
        pieces.append((str(Change.REMOVED), before))
        pieces.append((str(Change.ADDED), "".join(right[step.dest_start : step.dest_end])))
    return [piece for piece in pieces if piece[1]]


def _pieces(change: Change, parts: Iterable[tuple[str, Sequence[str]]]) -> Pieces:
    return [
        (str(Change.SAME if step == "equal" else change), "".join(words))
        for step, words in parts
        if words
    ]


def merged_difference(first: str, other: str) -> list[tuple[str, str]]:
    """Return ``other`` in reading notation as a list of (change, text), with what only ``first`` has in it."""
    left, right = form_of(first), form_of(other)
    if left is None or right is None:
        return unmarked(other)
    return [(str(span.change), span.text) for span in diff(left, right).merged_spans()]


def unmarked(text: str) -> list[tuple[str, str]]:
    form = form_of(text)
    return [(str(Change.SAME), to_reading(canonicalize(form)) if form else text)]
