"""Which nonterminals the commands of a grammar go through."""

from __future__ import annotations

from itertools import islice

from annotations.language.forms import Nonterminal, Symbols, Text, Wildcard
from annotations.language.grammar.budget import Budget
from annotations.language.grammar.expander import Expander, anonymized
from annotations.language.grammar.grammar import ROOT, Grammar

# No word of a grammar begins so.
_MARK = "\0"


def passages(
    grammar: Grammar, budget: Budget, most: int | None = None, root: str = ROOT
) -> dict[str, frozenset[str]]:
    """Return each anonymized command with the nonterminals below ``root`` that a derivation of it goes through.

    Args:
        most: look only at so many derivations; commands come in grammar order.

    Raises:
        TooManyCombinations: the budget is spent.
        LanguageError: the grammar has a cycle.
    """
    grammar.require_finite()

    def marked(name: str) -> tuple[Symbols, ...]:
        return tuple((Text(_MARK + name), *each) for each in grammar.alternatives(name))

    expander: Expander[str] = Expander(marked, _leaf)
    through: dict[str, frozenset[str]] = {}
    sets: dict[frozenset[str], frozenset[str]] = {}
    for items, _ in islice(expander.stream((Nonterminal(root),), budget), most):
        command = " ".join(item for item in items if not item.startswith(_MARK))
        names = frozenset(item[1:] for item in items if item.startswith(_MARK)) - {root}
        if command:
            names |= through.get(command, frozenset())
            through[command] = sets.setdefault(names, names)
    return through


def _leaf(symbol: Text | Wildcard) -> tuple[str, ...]:
    if isinstance(symbol, Text) and symbol.value.startswith(_MARK):
        return (symbol.value,)
    return anonymized(symbol)
