"""Change a form by what its words say differently: exchange predicates, add constraints for new slots."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from annotations.language.forms import CONJUNCTION, Application, Form, Lambda, Variable, predicates
from annotations.language.suggesting.alignment import Alignment
from annotations.language.suggesting.habits import Habits, words_of
from annotations.language.suggesting.slots import Key, keys_of
from annotations.language.suggesting.units import Slot, Unit
from annotations.language.symbols import Nonterminal

# Of the slots that a form leaves out, and of the predicates that say one.
MOST_ADDED, MOST_CONSTRAINTS = 2, 2


def exchange_predicates(
    form: Form, alignment: Alignment, habits: Habits, names: Iterable[str]
) -> Iterator[Form]:
    """Yield the form with a predicate that the left words say exchanged for one that the right words say."""
    names, present = tuple(names), frozenset(predicates(form))
    gone = [left for left, right in alignment.pairs if left and _is_other(left, right)]
    come = [right for left, right in alignment.pairs if right and _is_other(right, left)]
    old, new = habits.said_by(_words(gone), names), habits.said_by(_words(come), names)
    for added in sorted(new - present):
        for removed in sorted((old - new) & present):
            yield _rename(form, removed, added)


def add_slots(
    form: Form, slots: Mapping[Key, Slot], labels: Mapping[Key, str], habits: Habits
) -> Iterator[Form]:
    """Yield the form with constraints for slots that it leaves out, as other forms constrain their class."""
    missing = [key for key in slots if key not in keys_of(form)][:MOST_ADDED]
    forms = [form]
    for key in missing:
        usual = habits.constraints.get(labels[key])
        for predicate, _ in usual.most_common(MOST_CONSTRAINTS) if usual else ():
            for each in tuple(forms):
                forms.extend(_add(each, predicate, slots[key], habits))
    yield from forms[1:]


def _is_other(unit: Unit, counterpart: Unit | None) -> bool:
    return not unit.is_entity and (counterpart is None or counterpart.label != unit.label)


def _words(units: Iterable[Unit]) -> list[str]:
    return [word for unit in units for word in words_of(unit)]


def _rename(form: Form, old: str, new: str) -> Form:
    match form:
        case Lambda(variable, type_, bodies):
            return Lambda(variable, type_, tuple(_rename(body, old, new) for body in bodies))
        case Application(predicate, arguments):
            name = new if predicate == old else predicate
            return Application(name, tuple(_rename(each, old, new) for each in arguments))
        case _:
            return form


def _add(form: Form, predicate: str | Nonterminal, slot: Slot, habits: Habits) -> Iterator[Form]:
    """Yield the form with ``(predicate $v slot)`` added to each of its conjunctions in turn."""
    match form:
        case Lambda(variable, type_, (Application(predicate, conjuncts),)) if (
            predicate == CONJUNCTION
        ):
            added = Application(predicate, (Variable(variable), slot))
            whole = Application(CONJUNCTION, habits.place(conjuncts, added))
            yield Lambda(variable, type_, (whole,))
        case Lambda(variable, type_, bodies):
            if not any(isinstance(body, Lambda) for body in bodies):
                added = Application(predicate, (Variable(variable), slot))
                yield Lambda(variable, type_, habits.place(bodies, added))
            for each in _add_inside(bodies, predicate, slot, habits):
                yield Lambda(variable, type_, each)
        case Application(name, arguments):
            for each in _add_inside(arguments, predicate, slot, habits):
                yield Application(name, each)


def _add_inside(
    parts: tuple[Form, ...], predicate: str | Nonterminal, slot: Slot, habits: Habits
) -> Iterator[tuple[Form, ...]]:
    for place, part in enumerate(parts):
        for changed in _add(part, predicate, slot, habits):
            yield (*parts[:place], changed, *parts[place + 1 :])
