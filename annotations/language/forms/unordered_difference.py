"""Compare forms whose conjuncts stand in different orders: put them into the order that fits best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from annotations.language.forms.canonical import canonicalize
from annotations.language.forms.difference import Difference, diff
from annotations.language.forms.terms import CONJUNCTION, Application, Form, Lambda, size


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
