"""Say the form of one command with the slots of a pattern that makes it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, product

from annotations.language.forms import Application, Constant, Form, Lambda, walk
from annotations.language.grammar import Grammar
from annotations.language.suggesting.slots import key_of, slots_of
from annotations.language.suggesting.units import Slot, Unit, UnitReader
from annotations.language.symbols import Symbols

MOST_TRIED = 200  # ways to put slots in place of the constants of one form
MOST_LIFTED = 6


def lift_forms(form: Form, pattern: Symbols, grammar: Grammar) -> tuple[Form, ...]:
    """Return the forms of ``pattern`` that may give one of its commands ``form``, the most likely first.

    A slot takes the place of each constant that it can become; where several can, different constants take
    different slots, in the order of the pattern. None where a class token has no slot in the pattern.
    """
    units = UnitReader(grammar).units(pattern)
    texts = [str(each.value) for each in walk(form) if isinstance(each, Constant)]
    options = [_slots_for(text, units) for text in texts]
    if any(text.startswith("<") and not slots for text, slots in zip(texts, options, strict=True)):
        return ()
    chosen = list(islice(product(*(slots or (None,) for slots in options)), MOST_TRIED))
    most = max(map(_distinct, chosen))
    best = [_put(form, iter(each)) for each in chosen if _distinct(each) == most]
    return tuple(dict.fromkeys(best))[:MOST_LIFTED]


def _slots_for(text: str, units: Sequence[Unit]) -> tuple[Slot, ...]:
    """Return the slots of ``units`` that can become ``text``, as a form writes them."""
    able = [unit for unit in units if text.lower() in unit.phrases]
    return tuple(slots_of(able).values())


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
