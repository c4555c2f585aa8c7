"""Rename a nonterminal everywhere in a production, for ``; import file.txt as $name``."""

from __future__ import annotations

from dataclasses import replace

from annotations.language.grammar.productions import Production
from annotations.language.symbols import Choice, Nonterminal, Symbol, Symbols, Wildcard


def rename(production: Production, old: str, new: str) -> Production:
    """Return the production with ``$new`` for ``$old`` on both sides and in notes."""
    return Production(
        new if production.nonterminal == old else production.nonterminal,
        _rename(production.expansion, old, new),
        production.position,
        tuple((new if name == old else name, position) for name, position in production.references),
    )


def _rename(sequence: Symbols, old: str, new: str) -> Symbols:
    return tuple(_rename_symbol(symbol, old, new) for symbol in sequence)


def _rename_symbol(symbol: Symbol, old: str, new: str) -> Symbol:
    match symbol:
        case Nonterminal(name):
            return Nonterminal(new) if name == old else symbol
        case Choice(alternatives):
            return Choice(tuple(_rename(each, old, new) for each in alternatives))
        case Wildcard(meta=meta) if meta:
            return replace(symbol, meta=_rename(meta, old, new))
    return symbol
