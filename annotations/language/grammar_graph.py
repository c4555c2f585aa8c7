"""Which nonterminal reaches which: cycles, order from the leaves up, height."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from annotations.language.symbols import Choice, Nonterminal, Sequence

# No grammar in the field passes 15; the limit keeps recursion over a grammar far from Python's own.
MAX_HEIGHT = 80

Edges = Mapping[str, Iterable[str]]


@dataclass(frozen=True, slots=True)
class Traversal:
    """A depth-first walk over all nonterminals.

    ``order`` puts each one after those it refers to; each of ``cycles`` begins and ends with the
    same name.
    """

    order: tuple[str, ...]
    cycles: tuple[tuple[str, ...], ...]


def traverse(edges: Edges) -> Traversal:
    """Walks the graph without recursion; names that are no key have no edges."""
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
            elif child in path:
                names = list(path)
                cycles.append((*names[names.index(child) :], child))
            elif child not in finished and child in edges:
                path[child] = None
                stack.append((child, iter(edges[child])))
    return Traversal(tuple(order), tuple(cycles))


def reachable(edges: Edges, root: str) -> frozenset[str]:
    """``root`` and every name that can be reached from it, defined or not."""
    found = {root}
    waiting = [root]
    while waiting:
        for name in edges.get(waiting.pop(), ()):
            if name not in found:
                found.add(name)
                waiting.append(name)
    return frozenset(found)


def heights(rules: Mapping[str, tuple[Sequence, ...]], order: Iterable[str]) -> dict[str, int]:
    """How many nonterminals and choices nest at most in the words of each nonterminal.

    Args:
        rules: nonterminal → its alternatives, without a cycle.
        order: the order of a ``Traversal`` over them.
    """
    result: dict[str, int] = {}
    for name in order:
        result[name] = 1 + max((_height(each, result) for each in rules[name]), default=0)
    return result


def _height(sequence: Sequence, known: Mapping[str, int]) -> int:
    """Recursion goes as deep as choices nest, which ``brackets`` limits."""
    highest = 0
    for symbol in sequence:
        if isinstance(symbol, Nonterminal):
            highest = max(highest, known.get(symbol.name, 0))
        elif isinstance(symbol, Choice):
            inner = max(_height(each, known) for each in symbol.alternatives)
            highest = max(highest, 1 + inner)
    return highest
