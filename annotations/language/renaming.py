"""Renames a nonterminal everywhere in a production, as ``; import file.txt as $name`` asks."""

from __future__ import annotations

from dataclasses import replace

from annotations.language.productions import Production
from annotations.language.symbols import Choice, Nonterminal, Sequence, Symbol, Wildcard


def renamed_production(production: Production, old: str, new: str) -> Production:
    """The production with ``$new`` for ``$old`` on both sides, notes included."""
    return Production(
        new if production.nonterminal == old else production.nonterminal,
        _renamed(production.expansion, old, new),
        production.position,
        tuple((new if name == old else name, position) for name, position in production.references),
    )


def _renamed(sequence: Sequence, old: str, new: str) -> Sequence:
    return tuple(_renamed_symbol(symbol, old, new) for symbol in sequence)


def _renamed_symbol(symbol: Symbol, old: str, new: str) -> Symbol:
    match symbol:
        case Nonterminal(name):
            return Nonterminal(new) if name == old else symbol
        case Choice(alternatives):
            return Choice(tuple(_renamed(each, old, new) for each in alternatives))
        case Wildcard(meta=meta) if meta:
            return replace(symbol, meta=_renamed(meta, old, new))
    return symbol
