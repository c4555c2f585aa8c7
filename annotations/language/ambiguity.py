"""Lines of a grammar that repeat one another: one expansion, two derivations.

Whether a context-free grammar is ambiguous cannot be decided in general; this one is finite, and the
ambiguity that people write is a line that gives again what a line of the same nonterminal gave.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import groupby

from annotations.language.derivations import Expander
from annotations.language.errors import Problem, warning
from annotations.language.printing import print_sequence
from annotations.language.productions import Production
from annotations.language.symbols import Sequence, Text, Wildcard

# Lines with more expansions than this are not compared: the check is to answer while somebody waits.
COMPARED_EXPANSIONS = 2_000

Spoken = tuple[Text | Wildcard, ...]


def repetitions(
    productions: tuple[Production, ...], alternatives: Callable[[str], tuple[Sequence, ...]]
) -> Iterator[Problem]:
    """A warning at each line that gives again what an earlier line of its nonterminal gives.

    Wildcards count as they are written, id and constraint included; notes for the referee do not.
    The grammar has to be finite.
    """
    expander = Expander(alternatives, _spoken)
    by_name = sorted(productions, key=lambda each: each.nonterminal)  # stable: in file order
    for _, lines in groupby(by_name, key=lambda each: each.nonterminal):
        earlier: dict[Spoken, Production] = {}
        for line in lines:
            if expander.size(line.expansion) > COMPARED_EXPANSIONS:
                continue
            found = dict.fromkeys(items for items, _ in expander.stream(line.expansion))
            repeated = [items for items in earlier if items in found]
            if repeated and earlier[repeated[0]].expansion != line.expansion:
                yield _warning(line, earlier[repeated[0]], repeated[0], len(repeated), len(found))
            for items in found:
                earlier.setdefault(items, line)


def _warning(
    line: Production, first: Production, example: Spoken, repeated: int, total: int
) -> Problem:
    example_text = f'"{print_sequence(example)}"' if example else "saying nothing"
    return warning(
        line.position,
        f"ambiguous: of {total} expansions {repeated} stand at {first.position} already, "
        f"such as {example_text}",
        f"take it out of one of the two lines of ${line.nonterminal}",
    )


def _spoken(symbol: Text | Wildcard) -> Spoken:
    return () if isinstance(symbol, Wildcard) and symbol.kind == "void" else (symbol,)
