"""Solve "a is to b as c is to ?" for logical forms.

Proportional analogies over trees, after Lepage ("Solving analogies on words: an algorithm", COLING 1998)
and Ben Hassena and Miclet ("Tree analogical learning", 2011): what changes from a to b changes in c.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from operator import eq

from annotations.language.forms import Application, Form, Lambda, children


def solve(a: Form, b: Form, c: Form) -> Form | None:
    """Return the form that differs from ``c`` as ``b`` differs from ``a``; None if there is none.

    Slots that correspond have to be equal in the three forms.
    """
    if a == b:
        return c
    if a == c:
        return b
    if isinstance(a, Lambda) and isinstance(b, Lambda) and isinstance(c, Lambda):
        bodies = _solve_lists(a.bodies, b.bodies, c.bodies)
        return replace(c, bodies=bodies) if bodies else None
    if isinstance(a, Application) and isinstance(b, Application) and isinstance(c, Application):
        if a.predicate == b.predicate:
            predicate = c.predicate
        elif a.predicate == c.predicate:
            predicate = b.predicate
        else:
            return None
        arguments = _solve_lists(a.arguments, b.arguments, c.arguments)
        return Application(predicate, arguments) if arguments is not None else None
    return None


def _solve_lists(
    a: Sequence[Form], b: Sequence[Form], c: Sequence[Form]
) -> tuple[Form, ...] | None:
    if len(a) == len(b) == len(c):
        solved = [solve(*three) for three in zip(a, b, c, strict=True)]
        if None not in solved:
            return tuple(form for form in solved if form is not None)
    return _edit(a, b, c)


def _edit(a: Sequence[Form], b: Sequence[Form], c: Sequence[Form]) -> tuple[Form, ...] | None:
    """Apply the edits from ``a`` to ``b`` to the counterparts in ``c``."""
    counterparts = _counterparts(a, c)
    kept: dict[int, Form | None] = dict(enumerate(c))
    added: dict[int, list[Form]] = {}
    for tag, start, end, low, high in SequenceMatcher(None, a, b, False).get_opcodes():
        if tag == "equal":
            continue
        old, new = range(start, end), list(b[low:high])
        if any(place not in counterparts for place in old):
            return None
        if len(old) == len(new):
            for place, form in zip(old, new, strict=True):
                solved = solve(a[place], form, c[counterparts[place]])
                if solved is None:
                    return None
                kept[counterparts[place]] = solved
            continue
        for place in old:
            kept[counterparts[place]] = None
        if start - 1 in counterparts:
            at = counterparts[start - 1] + 1
        elif end in counterparts:
            at = counterparts[end]
        else:
            at = 0 if start == 0 < len(a) else len(c)
        added.setdefault(at, []).extend(new)
    edited: list[Form] = []
    for place in range(len(c) + 1):
        edited += added.get(place, [])
        left = kept.get(place)
        if left is not None:
            edited.append(left)
    return tuple(edited)


def _counterparts(a: Sequence[Form], c: Sequence[Form]) -> dict[int, int]:
    """Return the place in c for places in a: an equal form, or else one with the same head, in order."""
    pairs: dict[int, int] = {}
    for is_like in (eq, _has_same_head):
        for i, form in enumerate(a):
            if i in pairs:
                continue
            free = (j for j in range(len(c)) if j not in pairs.values() and is_like(form, c[j]))
            match = next(free, None)
            if match is not None:
                pairs[i] = match
    return pairs


def _has_same_head(first: Form, second: Form) -> bool:
    if isinstance(first, Application) and isinstance(second, Application):
        return first.predicate == second.predicate
    return type(first) is type(second) and bool(children(first))
