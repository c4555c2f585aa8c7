"""Read and print the symbols of a command grammar: words, nonterminals, wildcards and choices."""

from __future__ import annotations

from annotations.language.symbols.places import (
    SlotPlace,
    places_in_form,
    places_in_pattern,
    slot_key,
)
from annotations.language.symbols.printing import print_sequence, print_symbol, print_wildcard
from annotations.language.symbols.reader import SymbolReader
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
from annotations.language.symbols.wildcard_heads import NAMES as WILDCARD_NAMES
from annotations.language.symbols.wildcards import read_wildcard

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
    "places_in_form",
    "places_in_pattern",
    "print_sequence",
    "print_symbol",
    "print_wildcard",
    "read_wildcard",
    "slot_key",
    "walk",
]
