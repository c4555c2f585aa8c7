"""Repairs for slots: a nonterminal that nothing defines, a slot that only one side has."""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.forms import (
    Nonterminal,
    SlotPlace,
    Wildcard,
    places_in_form,
    places_in_pattern,
    print_symbol,
    slot_key,
)
from annotations.language.grammar import Grammar
from annotations.language.templates.candidates import (
    FORM,
    PATTERN,
    RepairCandidate,
    candidate,
    distance,
    nearest,
)
from annotations.language.templates.filling import bare
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import TextEdit

Slot = Nonterminal | Wildcard


def undefined(
    template: SemanticTemplate, grammar: Grammar, offset: int
) -> Iterator[RepairCandidate]:
    """Yield candidates for the nonterminal at ``offset`` of the pattern: defined ones with like names."""
    in_pattern = places_in_pattern(template.pattern_text)
    at = _at(in_pattern, offset)
    if at is None or not isinstance(at.slot, Nonterminal):
        return
    places = [(PATTERN, place) for place in in_pattern]
    places += ((FORM, place) for place in places_in_form(template.form_text))
    for name, rank in nearest(at.slot.name, grammar.rules):
        edits = [
            TextEdit(source, place.start, place.end, f"${name}")
            for source, place in places
            if place.slot == at.slot
        ]
        yield candidate(f"Write ${name}", edits, rank)


def form_only(
    template: SemanticTemplate, grammar: Grammar, offset: int
) -> Iterator[RepairCandidate]:
    """Yield candidates for the slot at ``offset`` of the form, which the pattern never produces.

    The form takes a slot of the pattern in its place, or the pattern takes the form's.
    """
    at = _at(places_in_form(template.form_text), offset)
    if at is None:
        return
    in_form = [place for place in places_in_form(template.form_text) if place.key == at.key]
    for slot, rank in _list_produced(template, grammar, at.slot):
        edits = [TextEdit(FORM, place.start, place.end, print_symbol(slot)) for place in in_form]
        yield candidate(f"Write {print_symbol(slot)}", edits, rank)
    said = {slot_key(slot) for slot in template.slots()}
    for place in places_in_pattern(template.pattern_text):
        if place.key not in said:
            text = print_symbol(bare(at.slot) if isinstance(at.slot, Wildcard) else at.slot)
            edits = [TextEdit(PATTERN, place.start, place.end, text)]
            rank = unlike(at.slot, place.slot) + 0.15
            written = template.pattern_text[place.start : place.end]
            yield candidate(f"Write {text} for {written} in the pattern", edits, rank)


def in_place_of(template: SemanticTemplate, grammar: Grammar, at: Slot | None) -> Iterator[Slot]:
    """Yield what the pattern produces and could stand where ``at`` is, the most likely first."""
    ranked = _list_produced(template, grammar, at)
    yield from (slot for slot, _ in sorted(ranked, key=lambda pair: pair[1]))


def unlike(slot: Slot, other: Slot) -> float:
    """Return how unlikely it is that one slot was meant by the other, from 0 to 2."""
    rank = distance(print_symbol(slot), print_symbol(other))
    return rank + (type(slot) is not type(other)) + (_class(slot) != _class(other)) / 2


def _list_produced(
    template: SemanticTemplate, grammar: Grammar, wanted: Slot | None
) -> Iterator[tuple[Slot, float]]:
    """Yield each slot that the pattern produces, bare, with its rank; those not in the form come first."""
    said = {slot_key(slot) for slot in template.slots()}
    seen = set()
    for symbol in grammar.spoken(template.pattern):
        key = slot_key(symbol)
        if key is None or key in seen or (isinstance(symbol, Wildcard) and not symbol.entity_class):
            continue
        seen.add(key)
        slot = bare(symbol) if isinstance(symbol, Wildcard) else symbol
        rank = unlike(wanted, slot) if wanted else 0.0
        yield slot, rank + (key in said) / 2


def _class(slot: Slot) -> str:
    return slot.entity_class if isinstance(slot, Wildcard) else ""


def _at(places: tuple[SlotPlace, ...], offset: int) -> SlotPlace | None:
    return next((each for each in places if each.start <= offset < each.end), None)
