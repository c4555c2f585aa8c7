"""Read and check a form that somebody gives an utterance."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from annotations.generation.assistance import shown_problem
from annotations.language.forms import (
    CLASS_TOKEN,
    Constant,
    Form,
    Nonterminal,
    Unknown,
    Wildcard,
    canonical_text,
    read_form,
    to_reading,
    walk,
)
from annotations.language.grammar import Grammar
from annotations.language.templates import (
    Sides,
    format_form,
    read_known_sides,
    template_checker,
    with_repairs,
)
from annotations.language.texts import (
    MAX_FORM,
    LanguageError,
    Offsets,
    Position,
    Problem,
    warning_at,
)
from annotations.language.world import gloss
from annotations.models import World
from annotations.rows.from_rows import classes_of, predicates_of

PLACE = Position("form")
STAND_IN = "do it"  # the pattern of a template whose form alone is looked at


def canonical_label(text: str, may_be_unknown: bool = False) -> str:
    """Return a form in any notation as canonical corpus text.

    Raises LanguageError where it cannot be read, is too long, is a template's, or is UNKNOWN and that is
    not ``may_be_unknown``.
    """
    return canonical_text(_read(text, may_be_unknown))


def check_label(
    world: World, anonymized_text: str, text: str, may_be_unknown: bool = False
) -> dict[str, Any]:
    """Check a form in any notation for an utterance, against the predicates of its world.

    Returns JSON as ``annotations.generation.assistance.assist`` does, without slots.
    """
    declared, classes = predicates_of(world), classes_of(world)
    sides, checker = Sides(STAND_IN, text), template_checker(Grammar(()), declared)
    reading = sentence = ""
    if len(text) > MAX_FORM:
        problems = tuple(_check_as_label(text, anonymized_text, may_be_unknown))
    else:
        template, unread = read_known_sides(STAND_IN, text, classes)
        remarks = checker.problems(template) if template else unread
        problems = tuple(each for each in remarks if each.position.source == PLACE.source)
        problems = with_repairs(problems, sides, checker, classes=classes)
        if template and not any(problem.is_error for problem in problems):
            problems += tuple(_check_as_label(text, anonymized_text, may_be_unknown))
            reading, sentence = to_reading(template.form), gloss(template.form, declared, classes)
    return {
        "problems": [shown_problem(each, sides) for each in problems],
        "formatted": {"form": format_form(text)} if len(text) <= MAX_FORM else {},
        "reading": reading,
        "gloss": sentence,
    }


def _check_as_label(text: str, anonymized_text: str, may_be_unknown: bool) -> Iterator[Problem]:
    """Yield why the form cannot be a label, or each class token in it that the utterance does not have."""
    try:
        form = _read(text, may_be_unknown)
    except LanguageError as error:
        yield error.problem
        return
    tokens_said = CLASS_TOKEN.findall(anonymized_text)
    said = {token.rstrip("0123456789") for token in tokens_said}
    tokens = (
        part.token_class for part in walk(form) if isinstance(part, Constant) and part.token_class
    )
    for name in dict.fromkeys(tokens):
        if name not in said:
            match = re.search(rf"\b{name}\d*\b", text)
            place = Offsets(text, PLACE.source).position(match.start()) if match else PLACE
            hint = "leave it out, or say which words name it"
            yield warning_at(place, f"the utterance names no {name}", hint)


def _read(text: str, may_be_unknown: bool) -> Form:
    form = read_form(text.strip(), PLACE)
    if isinstance(form, Unknown) and not may_be_unknown:
        raise LanguageError("UNKNOWN is an answer of its own", PLACE, "press u")
    for part in walk(form):
        for symbol in (part, getattr(part, "predicate", None)):
            if isinstance(symbol, Nonterminal | Wildcard):
                hint = "write a class token such as <object>, or a value"
                raise LanguageError(
                    "nonterminals and wildcards stand in templates only", PLACE, hint
                )
    return form
