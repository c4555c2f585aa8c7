"""What changes between two logical forms, as nested values and as marked text for two columns.

The alignment is Selkow's top-down tree edit distance (The tree-to-tree editing problem, 1977):
roots are paired, and their children are aligned in order by the cheapest way to remove, add and
pair whole subtrees.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import groupby
from operator import attrgetter

from annotations.language.forms.canonical import canonicalize
from annotations.language.forms.printing import to_reading
from annotations.language.forms.terms import Application, Form, Lambda, children, size


class Change(StrEnum):
    SAME = "same"
    ADDED = "added"
    REMOVED = "removed"
    CHANGED = "changed"


@dataclass(frozen=True, slots=True)
class Span:
    """A piece of the reading notation and what happened to it."""

    text: str
    change: Change


@dataclass(frozen=True, slots=True)
class Difference:
    """Two nodes that correspond, or one without a counterpart (the other side is None).

    ``change`` is about the node itself; what changes below is in ``children``, which is empty for a
    leaf and for a subtree that is added, removed or replaced as a whole. ``cost`` counts the
    changed nodes, 0 for equal forms.
    """

    change: Change
    left: Form | None
    right: Form | None
    cost: int
    children: tuple[Difference, ...] = ()

    def left_spans(self) -> tuple[Span, ...]:
        """Return the left form in reading notation, with what was removed or changed marked."""
        return _merge(_spans(self, attrgetter("left")))

    def right_spans(self) -> tuple[Span, ...]:
        """Return the right form in reading notation, with what was added or changed marked."""
        return _merge(_spans(self, attrgetter("right")))

    def merged_spans(self) -> tuple[Span, ...]:
        """Return the right form in reading notation, and in it, marked, what only the left one has."""
        return _merge(_spans(self, lambda node: node.left if node.right is None else node.right))


def diff(left: Form, right: Form) -> Difference:
    """Return the cheapest structural difference between the canonical forms of both."""
    return _pair(canonicalize(left), canonicalize(right))


def _pair(left: Form, right: Form) -> Difference:
    if left == right and not children(left):
        return Difference(Change.SAME, left, right, 0)
    if type(left) is not type(right) or not isinstance(left, Lambda | Application):
        return Difference(Change.CHANGED, left, right, max(size(left), size(right)))
    aligned = _align(children(left), children(right))
    is_same = _head(left) == _head(right)
    cost = sum(child.cost for child in aligned) + (not is_same)
    return Difference(Change.SAME if is_same else Change.CHANGED, left, right, cost, aligned)


def _align(left: tuple[Form, ...], right: tuple[Form, ...]) -> tuple[Difference, ...]:
    """Return the cheapest script; ``best[j]`` aligns the left nodes seen so far with the first j of right."""
    added = [Difference(Change.ADDED, None, form, size(form)) for form in right]
    best = [(sum(each.cost for each in added[:j]), tuple(added[:j])) for j in range(len(added) + 1)]
    for form in left:
        removed = Difference(Change.REMOVED, form, None, size(form))
        row = [_after(best[0], removed)]
        for j, other in enumerate(right):
            scripts = (
                _after(best[j], _pair(form, other)),
                _after(best[j + 1], removed),
                _after(row[j], added[j]),
            )
            row.append(min(scripts, key=lambda script: script[0]))
        best = row
    return best[-1][1]


def _after(
    script: tuple[int, tuple[Difference, ...]], step: Difference
) -> tuple[int, tuple[Difference, ...]]:
    return script[0] + step.cost, (*script[1], step)


def _head(form: Form) -> str:
    """Return what comes before the children in reading notation: ``λx`` or the predicate."""
    if isinstance(form, Application):
        return str(form.predicate)
    return to_reading(form).partition(". ")[0]


def _spans(node: Difference, side: Callable[[Difference], Form | None]) -> Iterator[Span]:
    form = side(node)
    if form is None:
        return
    parts = [child for child in node.children if side(child) is not None]
    if not parts:
        yield Span(to_reading(form), node.change)
        return
    is_lambda = isinstance(form, Lambda)
    opening, separator, closing = (". ", " ∧ ", "") if is_lambda else ("(", ", ", ")")
    yield Span(_head(form), node.change)
    yield Span(opening, Change.SAME)
    for number, child in enumerate(parts):
        is_grouped = is_lambda and isinstance(side(child), Lambda) and child is not parts[-1]
        yield Span((separator if number else "") + "(" * is_grouped, Change.SAME)
        yield from _spans(child, side)
        yield Span(")" * is_grouped, Change.SAME)
    yield Span(closing, Change.SAME)


def _merge(spans: Iterator[Span]) -> tuple[Span, ...]:
    """Join neighbouring spans with the same change."""
    groups = groupby((span for span in spans if span.text), key=lambda span: span.change)
    return tuple(Span("".join(span.text for span in group), change) for change, group in groups)
