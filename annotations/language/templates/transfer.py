"""Say the form of one pattern, or of one command, with the slots of another pattern."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, product

from annotations.language.forms import Application, Constant, Form, Lambda, Symbols, walk
from annotations.language.grammar import Grammar
from annotations.language.templates.alignment import align, weigh
from annotations.language.templates.form_slots import exchange, has_absent, key_of, slots_of
from annotations.language.templates.units import Slot, UnitReader

MOST_TRIED = 200  # ways to put slots in place of the constants of one form
MOST_LIFTED = 6


def transfer_form(form: Form, source: Symbols, target: Symbols, grammar: Grammar) -> Form | None:
    """Return the form of pattern ``source`` with the slots of pattern ``target`` that stand in the same places.

    None if a slot of the form has no counterpart there.
    """
    reader = UnitReader(grammar)
    left, right = reader.units(source), reader.units(target)
    own = slots_of(right)
    pairs = align(left, right, weigh((left, right))).slots().items()
    moved = exchange(form, {key_of(old): own[key_of(new)] for old, new in pairs})
    return None if has_absent(moved) else moved


def lift_forms(form: Form, pattern: Symbols, grammar: Grammar) -> tuple[Form, ...]:
    """Return the forms of ``pattern`` that may give one of its commands ``form``, the most likely first.

    A slot takes the place of each constant that it can become; where several can, different constants take
    different slots, in the order of the pattern. None where a class token has no slot in the pattern.
    """
    units = UnitReader(grammar).units(pattern)
    texts = [str(each.value) for each in walk(form) if isinstance(each, Constant)]
    options = [
        tuple(slots_of(unit for unit in units if text.lower() in unit.phrases).values())
        for text in texts
    ]
    if any(text.startswith("<") and not slots for text, slots in zip(texts, options, strict=True)):
        return ()
    chosen = list(islice(product(*(slots or (None,) for slots in options)), MOST_TRIED))
    most = max(map(_distinct, chosen))
    best = [_put(form, iter(each)) for each in chosen if _distinct(each) == most]
    return tuple(dict.fromkeys(best))[:MOST_LIFTED]


def _distinct(slots: Sequence[Slot | None]) -> int:
    return len({key_of(slot) for slot in slots if slot is not None})


def _put(form: Form, slots: Iterator[Slot | None]) -> Form:
    """Return the form with the next of ``slots`` in place of each constant; None leaves it."""
    match form:
        case Lambda(variable, type_, bodies):
            return Lambda(variable, type_, tuple(_put(body, slots) for body in bodies))
        case Application(predicate, arguments):
            return Application(predicate, tuple(_put(each, slots) for each in arguments))
        case Constant():
            return next(slots) or form
        case _:
            return form
