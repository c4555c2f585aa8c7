"""Say the form of one pattern with the slots of another."""

from __future__ import annotations

from annotations.language.forms import Form
from annotations.language.grammar import Grammar
from annotations.language.suggesting.alignment import align, weigh
from annotations.language.suggesting.slots import exchange, has_absent, key_of, slots_of
from annotations.language.suggesting.units import UnitReader
from annotations.language.symbols import Symbols


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
