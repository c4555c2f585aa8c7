"""Rename a nonterminal in the expansion of a production and on both sides of a template."""

from __future__ import annotations

from collections.abc import Iterable

from annotations.language.errors import LanguageError, Position
from annotations.language.renaming.texts import replace_parts
from annotations.language.symbols import (
    Nonterminal,
    SlotPlace,
    SymbolReader,
    places_in_form,
    places_in_pattern,
)


def rename_nonterminal_in_pattern(text: str, old: str, new: str) -> str:
    """Return a pattern or an expansion with ``$new`` for ``$old``, also in the notes of wildcards.

    A text that cannot be read, such as a draft, is changed outside of notes.
    """
    reader = SymbolReader(text, Position())
    try:
        reader.whole_line()
    except LanguageError:
        return _rename_places(text, places_in_pattern(text), old, new)
    starts = sorted(place.column - 1 for name, place in reader.references if name == old)
    return replace_parts(text, ((start, start + 1 + len(old)) for start in starts), f"${new}")


def rename_nonterminal_in_form(text: str, old: str, new: str) -> str:
    """Return a form with ``$new`` for ``$old``, as an argument or as a predicate."""
    return _rename_places(text, places_in_form(text), old, new)


def _rename_places(text: str, places: Iterable[SlotPlace], old: str, new: str) -> str:
    wanted = Nonterminal(old)
    parts = ((place.start, place.end) for place in places if place.slot == wanted)
    return replace_parts(text, parts, f"${new}")
