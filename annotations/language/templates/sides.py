"""The two sides of a template: their layout, and which characters of both write the same slot."""

from __future__ import annotations

from dataclasses import dataclass

from annotations.language.forms import (
    EntityClasses,
    Nonterminal,
    SlotPlace,
    SymbolReader,
    kinds_in_form,
    kinds_in_pattern,
    places_in_form,
    places_in_pattern,
    print_sequence,
    read_template_form,
    slot_key,
    split_head,
    to_template,
)
from annotations.language.grammar import Grammar
from annotations.language.templates.templates import SemanticTemplate, read_sides
from annotations.language.texts import LanguageError, Position, Problem


def format_pattern(text: str) -> str:
    """Return the pattern with single spaces; a text that cannot be read as it is."""
    name, start = split_head(text)
    try:
        pattern = print_sequence(SymbolReader(text[start:].strip(), Position()).whole_line())
    except LanguageError:
        return text
    return f"${name} -> {pattern}" if name else pattern


def format_form(text: str) -> str:
    """Return the form in template notation on one line; a text that cannot be read as it is."""
    try:
        return to_template(read_template_form(text))
    except LanguageError:
        return text


def read_known_sides(
    pattern: str, form: str, classes: EntityClasses
) -> tuple[SemanticTemplate | None, tuple[Problem, ...]]:
    """Read both sides as ``read_sides`` does. A wildcard that is of none of ``classes`` cannot be read."""
    template, problems = read_sides(pattern, form)
    unread = {problem.position.source for problem in problems}
    found: list[Problem] = []
    if "pattern" not in unread:
        found += kinds_in_pattern(pattern, classes, Position("pattern"))
    if "form" not in unread:
        found += kinds_in_form(form, classes, Position("form"))
    return (None if found else template), (*problems, *found)


@dataclass(frozen=True, slots=True)
class Correspondence:
    """The places of one slot in the pattern and in the form; both have at least one."""

    in_pattern: tuple[SlotPlace, ...]
    in_form: tuple[SlotPlace, ...]


def correspondences(pattern: str, form: str, grammar: Grammar) -> tuple[Correspondence, ...]:
    """Return the slots that both sides have, in the order of the form.

    A wildcard that the pattern does not write itself stands where a nonterminal of the pattern
    produces it. Works on texts that cannot be read.
    """
    spoken = places_in_pattern(pattern)
    in_form: dict[object, list[SlotPlace]] = {}
    for place in places_in_form(form):
        if place.key is not None:
            in_form.setdefault(place.key, []).append(place)
    corresponding: list[Correspondence] = []
    for key, places in in_form.items():
        in_pattern = [place for place in spoken if place.key == key] or [
            place
            for place in spoken
            if isinstance(place.slot, Nonterminal)
            and any(slot_key(symbol) == key for symbol in grammar.spoken((place.slot,)))
        ]
        if in_pattern:
            corresponding.append(Correspondence(tuple(in_pattern), tuple(places)))
    return tuple(corresponding)
