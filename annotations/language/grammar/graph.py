"""Which nonterminal reaches which: cycles, order from the leaves up, height and length."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from annotations.language.forms import Choice, Nonterminal, Symbols, Text

# Known grammars nest at most 15 deep; this keeps recursion over a grammar far below Python's limit.
MAX_HEIGHT = 80
# Words of the longest command. The published grammars stay below 35; long expansions cost more.
MAX_WORDS = 500
MOST_CYCLES = 50

Edges = Mapping[str, Iterable[str]]


@dataclass(frozen=True, slots=True)
class Traversal:
    """A depth-first walk over all nonterminals.

    ``order`` puts each nonterminal after those it refers to; each of ``cycles`` begins and ends
    with the same name.
    """

    order: tuple[str, ...]
    cycles: tuple[tuple[str, ...], ...]


def traverse(edges: Edges) -> Traversal:
    """Walk the graph without recursion; names that are not keys have no edges.

    Only the first ``MOST_CYCLES`` cycles are reported: each path can be as long as the grammar.
    """
    order: list[str] = []
    cycles: list[tuple[str, ...]] = []
    finished: set[str] = set()
    for start in edges:
        path: dict[str, None] = {}
        stack = [(start, iter((start,)))] if start not in finished else []
        while stack:
            parent, remaining = stack[-1]
            child = next(remaining, None)
            if child is None:
                stack.pop()
                if stack:
                    path.pop(parent)
                    finished.add(parent)
                    order.append(parent)
            elif child in path and len(cycles) < MOST_CYCLES:
                names = list(path)
                cycles.append((*names[names.index(child) :], child))
            elif child not in finished and child not in path and child in edges:
                path[child] = None
                stack.append((child, iter(edges[child])))
    return Traversal(tuple(order), tuple(cycles))


def reachable(edges: Edges, root: str) -> frozenset[str]:
    """Return ``root`` and every name that can be reached from it, defined or not."""
    reached = {root}
    waiting = [root]
    while waiting:
        for name in edges.get(waiting.pop(), ()):
            if name not in reached:
                reached.add(name)
                waiting.append(name)
    return frozenset(reached)


def heights(rules: Mapping[str, tuple[Symbols, ...]], order: Iterable[str]) -> dict[str, int]:
    """Return how deep nonterminals and choices nest in each nonterminal, counting itself.

    Args:
        rules: nonterminal → its alternatives, without a cycle.
        order: the order of a ``Traversal`` over them.
    """
    result: dict[str, int] = {}
    for name in order:
        result[name] = 1 + max((_height(each, result) for each in rules[name]), default=0)
    return result


def _height(sequence: Symbols, known: Mapping[str, int]) -> int:
    """Return how deep nonterminals and choices nest in a sequence.

    The recursion is as deep as choices nest, which ``limits.MAX_NESTING`` bounds.
    """
    highest = 0
    for symbol in sequence:
        if isinstance(symbol, Nonterminal):
            highest = max(highest, known.get(symbol.name, 0))
        elif isinstance(symbol, Choice):
            inner = max(_height(each, known) for each in symbol.alternatives)
            highest = max(highest, 1 + inner)
    return highest


def lengths(rules: Mapping[str, tuple[Symbols, ...]], order: Iterable[str]) -> dict[str, int]:
    """Return the largest number of words of each nonterminal; arguments as in ``heights``."""
    result: dict[str, int] = {}
    for name in order:
        result[name] = max(1, *(length(each, result) for each in rules[name]))
    return result


def length(sequence: Symbols, known: Mapping[str, int]) -> int:
    """Return the largest number of words of a sequence, given the lengths of its nonterminals.

    A nonterminal or a choice without words counts as one word: it costs as much to expand.
    """
    total = 0
    for symbol in sequence:
        if isinstance(symbol, Nonterminal):
            total += known.get(symbol.name, 0)
        elif isinstance(symbol, Choice):
            total += max(1, *(length(each, known) for each in symbol.alternatives))
        elif isinstance(symbol, Text) or symbol.token:
            total += 1
    return total
