"""What changes between two logical forms, as nested values and as marked text for two columns.

The alignment is Selkow's top-down tree edit distance (The tree-to-tree editing problem, 1977):
roots are paired, and their children are aligned in order by the cheapest way to remove, add and
pair whole subtrees.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import groupby
from operator import attrgetter

from annotations.language.forms.canonical import canonicalize
from annotations.language.forms.notations import to_reading
from annotations.language.forms.terms import CONJUNCTION, Application, Form, Lambda, children, size

# Nodes of one side times nodes of the other, above which siblings are paired by their places instead: people
# may write forms of hundreds of nodes, and aligning those takes seconds.
MOST_PAIRS = 40_000


class Change(StrEnum):
    SAME = "same"
    ADDED = "added"
    REMOVED = "removed"
    CHANGED = "changed"


@dataclass(frozen=True, slots=True)
class MarkedText:
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

    def left_spans(self) -> tuple[MarkedText, ...]:
        """Return the left form in reading notation, with what was removed or changed marked."""
        return _merge(_spans(self, attrgetter("left")))

    def right_spans(self) -> tuple[MarkedText, ...]:
        """Return the right form in reading notation, with what was added or changed marked."""
        return _merge(_spans(self, attrgetter("right")))

    def merged_spans(self) -> tuple[MarkedText, ...]:
        """Return the right form in reading notation, and in it, marked, what only the left one has."""
        return _merge(_spans(self, lambda node: node.left if node.right is None else node.right))


def diff(left: Form, right: Form) -> Difference:
    """Return the cheapest structural difference between the canonical forms of both."""
    return _pair(canonicalize(left), canonicalize(right))


def _pair(left: Form, right: Form) -> Difference:
    if not children(left) and left == right:
        return Difference(Change.SAME, left, right, 0)
    if type(left) is not type(right) or not isinstance(left, Lambda | Application):
        return Difference(Change.CHANGED, left, right, max(size(left), size(right)))
    aligned = _align(children(left), children(right))
    is_same = _head(left) == _head(right)
    cost = sum(child.cost for child in aligned) + (not is_same)
    return Difference(Change.SAME if is_same else Change.CHANGED, left, right, cost, aligned)


# The cost of the cheapest script so far, the script before its last step, and that step.
_Script = tuple[int, "_Script | None", Difference | None]


def _align(left: tuple[Form, ...], right: tuple[Form, ...]) -> tuple[Difference, ...]:
    """Return the cheapest script; ``best[j]`` aligns the left nodes seen so far with the first j of right."""
    removed = [Difference(Change.REMOVED, form, None, size(form)) for form in left]
    added = [Difference(Change.ADDED, None, form, size(form)) for form in right]
    if sum(each.cost for each in removed) * sum(each.cost for each in added) > MOST_PAIRS:
        paired = tuple(map(_pair, left, right))
        return (*paired, *removed[len(paired) :], *added[len(paired) :])
    best: list[_Script] = [(0, None, None)]
    for each in added:
        best.append(_after(best[-1], each))
    for form, without in zip(left, removed, strict=True):
        row = [_after(best[0], without)]
        for j, other in enumerate(right):
            scripts = (
                _after(best[j], _pair(form, other)),
                _after(best[j + 1], without),
                _after(row[j], added[j]),
            )
            row.append(min(scripts, key=lambda script: script[0]))
        best = row
    steps: list[Difference] = []
    _, before, step = best[-1]
    while before is not None and step is not None:
        steps.append(step)
        _, before, step = before
    return tuple(reversed(steps))


def _after(script: _Script, step: Difference) -> _Script:
    return script[0] + step.cost, script, step


def _head(form: Form) -> str:
    """Return what comes before the children in reading notation: ``λx`` or the predicate."""
    if isinstance(form, Application):
        return str(form.predicate)
    return to_reading(form).partition(". ")[0]


def _spans(node: Difference, side: Callable[[Difference], Form | None]) -> Iterator[MarkedText]:
    form = side(node)
    if form is None:
        return
    parts = [child for child in node.children if side(child) is not None]
    if not parts:
        yield MarkedText(to_reading(form), node.change)
        return
    is_lambda = isinstance(form, Lambda)
    opening, separator, closing = (". ", " ∧ ", "") if is_lambda else ("(", ", ", ")")
    yield MarkedText(_head(form), node.change)
    yield MarkedText(opening, Change.SAME)
    for number, child in enumerate(parts):
        is_grouped = is_lambda and isinstance(side(child), Lambda) and child is not parts[-1]
        yield MarkedText((separator if number else "") + "(" * is_grouped, Change.SAME)
        yield from _spans(child, side)
        yield MarkedText(")" * is_grouped, Change.SAME)
    yield MarkedText(closing, Change.SAME)


def _merge(spans: Iterator[MarkedText]) -> tuple[MarkedText, ...]:
    """Join neighbouring spans with the same change."""
    groups = groupby((span for span in spans if span.text), key=lambda span: span.change)
    return tuple(
        MarkedText("".join(span.text for span in group), change) for change, group in groups
    )


def diff_unordered(left: Form, right: Form) -> Difference:
    """Return ``diff`` after the conjuncts of ``right`` are put into the order that fits ``left`` best.

    Conjuncts are those of ``equivalent``; between equivalent forms nothing changes.
    """
    return diff(left, order_like(right, left))


def order_like(form: Form, model: Form) -> Form:
    """Return the canonical form of ``form`` with its conjuncts in the order of those of ``model``.

    Conjuncts are assigned to each other so that the least has to change (Kuhn 1955); those without a
    counterpart follow in their own order.
    """
    return _order(canonicalize(form), canonicalize(model))


def _order(form: Form, model: Form) -> Form:
    if isinstance(form, Lambda) and isinstance(model, Lambda):
        return replace(form, bodies=_assign(form.bodies, model.bodies))
    if isinstance(form, Application) and isinstance(model, Application):
        if form.predicate == model.predicate == CONJUNCTION:
            return replace(form, arguments=_assign(form.arguments, model.arguments))
        pairs = zip(form.arguments, model.arguments, strict=False)
        ordered = tuple(_order(mine, its) for mine, its in pairs)
        return replace(form, arguments=ordered + form.arguments[len(ordered) :])
    return form


def _assign(own: Sequence[Form], others: Sequence[Form]) -> tuple[Form, ...]:
    """Return ``own`` in the order of their counterparts among ``others``."""
    if not own or not others:
        return tuple(own)
    if len(own) == len(others) == 1:
        return (_order(own[0], others[0]),)
    if sum(map(size, own)) * sum(map(size, others)) > MOST_PAIRS:
        return tuple(own)
    # Half a second, which a start can do without.
    from scipy.optimize import linear_sum_assignment

    ordered = [[_order(mine, its) for its in others] for mine in own]
    kept = [
        [
            size(mine) + size(its) - diff(mine, its).cost
            for mine, its in zip(row, others, strict=True)
        ]
        for row in ordered
    ]
    rows, columns = linear_sum_assignment(kept, maximize=True)
    pairs = sorted((int(column), int(row)) for row, column in zip(rows, columns, strict=True))
    assigned = [ordered[row][column] for column, row in pairs]
    used = {row for _, row in pairs}
    return (*assigned, *(form for row, form in enumerate(own) if row not in used))
