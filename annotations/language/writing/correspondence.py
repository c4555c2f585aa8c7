"""Which characters of a pattern and of a form write the same slot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from annotations.language.grammar import Grammar
from annotations.language.symbols import (
    Nonterminal,
    SlotPlace,
    places_in_form,
    places_in_pattern,
    slot_key,
)


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
    return tuple(
        Correspondence(in_pattern, tuple(places))
        for key, places in in_form.items()
        if (in_pattern := tuple(_sources(key, spoken, grammar)))
    )


def _sources(key: object, spoken: tuple[SlotPlace, ...], grammar: Grammar) -> Iterator[SlotPlace]:
    """Yield the places that write a slot, or else those of nonterminals that produce it."""
    same = [place for place in spoken if place.key == key]
    yield from same
    for place in () if same else spoken:
        if isinstance(place.slot, Nonterminal) and any(
            slot_key(symbol) == key for symbol in grammar.spoken((place.slot,))
        ):
            yield place
