"""Read and print the symbols of a command grammar: words, nonterminals, wildcards and choices."""

from __future__ import annotations

from annotations.language.symbols.cursor import lone_closing_parentheses
from annotations.language.symbols.entity_classes import (
    DEFAULT_CLASSES,
    HUES,
    MAX_CLASS_WORDS,
    MAX_TOKEN,
    MOST_CLASSES,
    EntityClass,
    EntityClasses,
    is_token,
    require_token,
    wildcard_names,
)
from annotations.language.symbols.kind_checks import kinds_in_form, kinds_in_pattern
from annotations.language.symbols.printing import print_sequence, print_symbol, print_wildcard
from annotations.language.symbols.reader import SymbolReader, read_wildcard
from annotations.language.symbols.slot_places import (
    SlotPlace,
    places_in_form,
    places_in_pattern,
    slot_key,
    split_head,
)
from annotations.language.symbols.symbols import (
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
    walk_symbols,
)

__all__ = [
    "DEFAULT_CLASSES",
    "HUES",
    "MAX_CLASS_WORDS",
    "MAX_TOKEN",
    "MOST_CLASSES",
    "TYPES",
    "Choice",
    "Combination",
    "Comparison",
    "Condition",
    "EntityClass",
    "EntityClasses",
    "Negation",
    "Nonterminal",
    "SlotPlace",
    "Symbol",
    "SymbolReader",
    "Symbols",
    "Text",
    "Wildcard",
    "is_token",
    "kinds_in_form",
    "kinds_in_pattern",
    "lone_closing_parentheses",
    "places_in_form",
    "places_in_pattern",
    "print_sequence",
    "print_symbol",
    "print_wildcard",
    "read_wildcard",
    "require_token",
    "slot_key",
    "split_head",
    "walk_symbols",
    "wildcard_names",
]
