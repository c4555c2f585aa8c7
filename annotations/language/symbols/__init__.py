"""Read and print the symbols of a command grammar: words, nonterminals, wildcards and choices."""

from __future__ import annotations

from annotations.language.symbols.cursor import lone_closing_parentheses
from annotations.language.symbols.printing import print_sequence, print_symbol, print_wildcard
from annotations.language.symbols.reader import NAMES as WILDCARD_NAMES
from annotations.language.symbols.reader import SymbolReader, read_wildcard
from annotations.language.symbols.slot_places import (
    SlotPlace,
    places_in_form,
    places_in_pattern,
    slot_key,
    split_head,
)
from annotations.language.symbols.symbols import (
    ENTITY_CLASSES,
    TYPES,
    Choice,
    Combination,
    Comparison,
    Condition,
    Negation,
    Nonterminal,
    Symbol,
    Symbols,
    Text,
    Wildcard,
    walk,
)

__all__ = [
    "ENTITY_CLASSES",
    "TYPES",
    "WILDCARD_NAMES",
    "Choice",
    "Combination",
    "Comparison",
    "Condition",
    "Negation",
    "Nonterminal",
    "SlotPlace",
    "Symbol",
    "SymbolReader",
    "Symbols",
    "Text",
    "Wildcard",
    "lone_closing_parentheses",
    "places_in_form",
    "places_in_pattern",
    "print_sequence",
    "print_symbol",
    "print_wildcard",
    "read_wildcard",
    "slot_key",
    "split_head",
    "walk",
]
