"""Find lines of a grammar that repeat each other: one expansion with two derivations.

It cannot be decided in general whether a context-free grammar is ambiguous. But this one is finite,
and the ambiguity that people write is a line that repeats an expansion of an earlier line of the
same nonterminal.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import groupby

from annotations.language.errors import Problem, warning_at
from annotations.language.grammar.budget import Budget, TooManyCombinations
from annotations.language.grammar.expander import Expander
from annotations.language.grammar.productions import Production
from annotations.language.symbols import Symbols, Text, Wildcard, print_sequence

# Lines with more expansions than this are not compared: somebody waits for the answer.
COMPARED_EXPANSIONS = 2_000
COMPARED_STEPS = 4_000_000  # for all lines together; the published grammars take 700,000
STEPS_PER_SYMBOL = 4  # the cost of comparing one symbol

Spoken = tuple[Text | Wildcard, ...]


def repetitions(
    productions: tuple[Production, ...], alternatives: Callable[[str], tuple[Symbols, ...]]
) -> Iterator[Problem]:
    """Yield a warning at each line that repeats an expansion of an earlier line of its nonterminal.

    Wildcards count as they are written, with id and constraint; notes for the referee do not count.
    The grammar has to be finite. Lines for which ``COMPARED_STEPS`` are not enough are not
    compared.
    """
    expander, budget = Expander(alternatives, _keep_spoken), Budget(COMPARED_STEPS)
    by_name = sorted(productions, key=lambda each: each.nonterminal)  # stable: in file order
    for _, lines in groupby(by_name, key=lambda each: each.nonterminal):
        earlier: dict[Spoken, tuple[int, Production]] = {}  # with its number in order of appearance
        for line in lines:
            if expander.size(line.expansion) > COMPARED_EXPANSIONS:
                continue
            try:
                spoken = _expand(expander, line, budget)
            except TooManyCombinations:
                yield _stop_at(line)
                return
            repeated = [items for items in spoken if items in earlier]
            example = min(repeated, key=lambda items: earlier[items][0], default=())
            if repeated and (first := earlier[example][1]).expansion != line.expansion:
                yield _warn_of(line, first, example, len(repeated), len(spoken))
            for items in spoken:
                earlier.setdefault(items, (len(earlier), line))


def _expand(
    expander: Expander[Text | Wildcard], line: Production, budget: Budget
) -> dict[Spoken, None]:
    """Return the distinct expansions of a line, in order."""
    expansions: dict[Spoken, None] = {}
    for items, _ in expander.stream(line.expansion, budget):
        budget.spend(STEPS_PER_SYMBOL * len(items))
        expansions[items] = None
    return expansions


def _warn_of(
    line: Production, first: Production, example: Spoken, repeated: int, total: int
) -> Problem:
    example_text = f'"{print_sequence(example)}"' if example else "saying nothing"
    return warning_at(
        line.position,
        f"ambiguous: {repeated} of {total} expansions {'repeats' if repeated == 1 else 'repeat'} "
        f"{first.position}, such as {example_text}",
        f"remove it from one of the two lines of ${line.nonterminal}",
    )


def _stop_at(line: Production) -> Problem:
    return warning_at(
        line.position,
        "too many combinations to look for repeated lines from here on",
        "ignore this if no line repeats another",
    )


def _keep_spoken(symbol: Text | Wildcard) -> Spoken:
    return () if isinstance(symbol, Wildcard) and symbol.kind == "void" else (symbol,)
