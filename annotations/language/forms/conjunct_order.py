"""What stands beside what in the conjunctions of forms, and in which order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from annotations.language.forms.terms import CONJUNCTION, Application, Form, Lambda, walk


@dataclass(frozen=True)
class ConjunctOrder:
    """``before`` counts how often a conjunct with one head comes before one with another."""

    before: Counter[tuple[str, str]]

    def place(self, heads: Sequence[str], new: str) -> int:
        """Return the place of ``new`` among ``heads`` that agrees best with the usual order."""

        def agreement(place: int) -> int:
            behind = sum(self._net(head, new) for head in heads[:place])
            return behind + sum(self._net(new, head) for head in heads[place:])

        return max(range(len(heads) + 1), key=agreement)

    def together(self, heads: Iterable[str], new: str) -> int:
        """Count how often ``new`` stands beside one of ``heads``."""
        return sum(self.before[head, new] + self.before[new, head] for head in set(heads))

    def _net(self, first: str, second: str) -> int:
        return self.before[first, second] - self.before[second, first]


def order_of(forms: Iterable[Form]) -> ConjunctOrder:
    """Count the order of the conjuncts of ``forms``."""
    before: Counter[tuple[str, str]] = Counter()
    for form in forms:
        for conjuncts in conjunctions(form):
            before.update(combinations(map(head_of, conjuncts), 2))
    return ConjunctOrder(before)


def conjunctions(form: Form) -> Iterator[tuple[Form, ...]]:
    """Yield the bodies of each λ and the arguments of each ``and``."""
    for node in walk(form):
        if isinstance(node, Lambda):
            yield node.bodies
        elif isinstance(node, Application) and node.predicate == CONJUNCTION:
            yield node.arguments


def head_of(form: Form) -> str:
    """Return the predicate of an application, the kind of any other term."""
    return str(form.predicate) if isinstance(form, Application) else type(form).__name__
