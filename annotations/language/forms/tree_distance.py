"""How far two logical forms are from each other, from 0 (equivalent) to 1 (nothing in common).

The distance is Zhang's constrained edit distance between unordered labelled trees (A constrained
edit distance between unordered labeled trees, Algorithmica 15, 1996) where adding or removing a node
costs 1 and changing one costs 2. It then counts the nodes that two trees do not share. It is divided
by the number of different nodes, which keeps it a metric (Li and Zhang, A metric normalization of
tree edit distance, Frontiers of Computer Science in China 5, 2011).

As trees, forms have no order and no names of variables: a variable is the number of λs between it
and its own (de Bruijn 1972), and an argument carries its position in its label. Conjuncts all have
position 0, so that their order does not matter.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from itertools import combinations

from annotations.language.forms.terms import (
    CONJUNCTION,
    Application,
    Form,
    Lambda,
    Variable,
    children,
)


@dataclass(frozen=True, slots=True)
class _Node:
    """A subtree: the numbers of the subtrees below it in ascending order, the count of its nodes, all labels."""

    label: Hashable
    children: tuple[int, ...]
    size: int
    labels: frozenset[Hashable]


class FormDistances:
    """Distances between forms. Subtrees that forms share are compared once, however many forms there are."""

    def __init__(self) -> None:
        self._nodes: list[_Node] = []
        self._numbers: dict[tuple[Hashable, tuple[int, ...]], int] = {}
        self._trees: dict[tuple[int, int], int] = {}
        self._forests: dict[tuple[int, int], int] = {}

    def distance(self, first: Form, second: Form) -> float:
        """Return the share of nodes that the two forms do not have in common.

        0 exactly for forms that are ``equivalent``, 1 for forms without a common node.
        """
        return self._distance(self.number(first), self.number(second))

    def matrix(self, forms: Sequence[Form]) -> list[list[float]]:
        """Return the distances of all pairs, [forms, forms]."""
        numbers = [self.number(form) for form in forms]
        rows = [[0.0] * len(forms) for _ in forms]
        for i, j in combinations(range(len(forms)), 2):
            rows[i][j] = rows[j][i] = self._distance(numbers[i], numbers[j])
        return rows

    def _distance(self, left: int, right: int) -> float:
        shared = self._shared_tree(left, right)
        return 1 - shared / (self._nodes[left].size + self._nodes[right].size - shared)

    def number(self, form: Form) -> int:
        """Return a number that exactly the equivalent forms share."""
        return self._number(form, 0, ())

    def _number(self, form: Form, position: int, binders: tuple[int, ...]) -> int:
        inner = (form.variable, *binders) if isinstance(form, Lambda) else binders
        has_order = isinstance(form, Application) and form.predicate != CONJUNCTION
        below = sorted(
            self._number(child, place if has_order else 0, inner)
            for place, child in enumerate(children(form))
        )
        kind: Hashable = form
        if isinstance(form, Lambda):
            kind = ("λ", form.type)
        elif isinstance(form, Application):
            kind = ("predicate", form.predicate)
        elif isinstance(form, Variable) and form.index in binders:
            kind = ("bound", binders.index(form.index))
        key = ((position, kind), tuple(below))
        number = self._numbers.setdefault(key, len(self._nodes))
        if number == len(self._nodes):
            label, inner_numbers = key
            size = 1 + sum(self._nodes[child].size for child in inner_numbers)
            inside = (self._nodes[child].labels for child in inner_numbers)
            self._nodes.append(
                _Node(label, inner_numbers, size, frozenset((label,)).union(*inside))
            )
        return number

    def _shared_tree(self, left: int, right: int) -> int:
        """Count the nodes that two trees share at most."""
        if left == right:
            return self._nodes[left].size
        first, second = self._nodes[left], self._nodes[right]
        if first.labels.isdisjoint(second.labels):
            return 0
        key = (left, right) if left < right else (right, left)
        if key not in self._trees:
            aligned = (first.label == second.label) + self._shared_forest(left, right)
            self._trees[key] = self._best_inside(self._shared_tree, left, right, aligned)
        return self._trees[key]

    def _shared_forest(self, left: int, right: int) -> int:
        """Count the nodes that the subtrees below two nodes share at most."""
        first, second = self._nodes[left].children, self._nodes[right].children
        if not first or not second:
            return 0
        key = (left, right) if left < right else (right, left)
        if key not in self._forests:
            shared = [[self._shared_tree(one, other) for other in second] for one in first]
            if len(first) == 1 or len(second) == 1:
                matched = max(map(max, shared))
            else:
                # Half a second, which a start can do without.
                from scipy.optimize import linear_sum_assignment

                rows, columns = linear_sum_assignment(shared, maximize=True)
                matched = sum(shared[i][j] for i, j in zip(rows, columns, strict=True))
            self._forests[key] = self._best_inside(self._shared_forest, left, right, matched)
        return self._forests[key]

    def _best_inside(
        self, shared: Callable[[int, int], int], left: int, right: int, best: int
    ) -> int:
        """Return ``best``, or the most that one side shares with a single subtree of the other."""
        pairs = [(left, child) for child in self._nodes[right].children]
        pairs += [(child, right) for child in self._nodes[left].children]
        for one, other in pairs:
            if min(self._nodes[one].size, self._nodes[other].size) > best:
                best = max(best, shared(one, other))
        return best
