"""The slots of forms: name them alike, exchange them, and take out what none is left for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeAlias

from annotations.language.forms import (
    Application,
    Constant,
    Form,
    Lambda,
    Nonterminal,
    Variable,
    Wildcard,
    walk,
)
from annotations.language.templates.filling import bare
from annotations.language.templates.units import Slot, Unit

# What is equal for a slot in a pattern and in a form: ``{beacon 1}`` with and without its note.
Key: TypeAlias = "Nonterminal | tuple[str, int | None]"


def key_of(slot: Slot) -> Key:
    """Return the identity of a slot."""
    return slot if isinstance(slot, Nonterminal) else slot.identity


def slots_of(units: Iterable[Unit]) -> dict[Key, Slot]:
    """Return the slots of a pattern by identity, as a form writes them."""
    slots = (unit.slot for unit in units if unit.slot is not None)
    return {key_of(slot): bare(slot) if isinstance(slot, Wildcard) else slot for slot in slots}


def labels_of(units: Iterable[Unit]) -> dict[Key, str]:
    """Return the label of each slot: the class token, or the phrases of a nonterminal."""
    return {key_of(unit.slot): unit.label for unit in units if unit.slot is not None}


def keys_of(form: Form) -> frozenset[Key]:
    """Return the identities of the slots of a form, those in place of a predicate too."""
    return frozenset(map(key_of, _slots(form)))


def absent(slot: Slot) -> Nonterminal:
    """Return a slot that stands for one without a counterpart; no grammar can define it."""
    return Nonterminal(f"absent {slot}")


def has_absent(form: Form) -> bool:
    """Return whether a form mentions a slot made by ``absent``."""
    return any(map(_is_absent, _slots(form)))


def exchange(form: Form, slots: Mapping[Key, Slot]) -> Form:
    """Return the form with every slot exchanged; one that is not in ``slots`` becomes ``absent``."""
    match form:
        case Lambda(variable, type_, bodies):
            return Lambda(variable, type_, tuple(exchange(body, slots) for body in bodies))
        case Application(predicate, arguments):
            if isinstance(predicate, Nonterminal):
                new = _exchange(predicate, slots)
                predicate = new if isinstance(new, Nonterminal) else absent(predicate)
            return Application(predicate, tuple(exchange(each, slots) for each in arguments))
        case Wildcard() | Nonterminal():
            return _exchange(form, slots)
        case _:
            return form


def drop_absent(form: Form) -> Form | None:
    """Return the form without what depends on absent slots; None if nothing is left."""
    match form:
        case Lambda(variable, type_, bodies):
            kept = _keep(bodies)
            return Lambda(variable, type_, kept) if kept else None
        case Application(predicate, arguments):
            kept = _keep(arguments)
            is_broken = len(kept) < len(arguments) and any(
                isinstance(each, Variable) for each in arguments
            )
            if is_broken or (arguments and not kept) or _is_absent(predicate):
                return None
            return Application(predicate, kept)
        case _:
            return None if _is_absent(form) else form


def with_classes(form: Form, labels: Mapping[Key, str]) -> Form:
    """Return the form with a class token for each slot that stands for an entity."""
    return _fill(form, {key: label for key, label in labels.items() if label.startswith("<")})


def fillings(form: Form, labels: Mapping[Key, str]) -> Iterator[Form]:
    """Yield the form as commands have it, once for each phrase of the nonterminal with the most of them."""
    texts = {key: labels[key].split("|") for key in keys_of(form) if key in labels}
    for number in range(max(map(len, texts.values()), default=1)):
        yield _fill(form, {key: each[number % len(each)] for key, each in texts.items()})


def _fill(form: Form, texts: Mapping[Key, str]) -> Form:
    match form:
        case Lambda(variable, type_, bodies):
            return Lambda(variable, type_, tuple(_fill(body, texts) for body in bodies))
        case Application(predicate, arguments):
            if isinstance(predicate, Nonterminal) and predicate in texts:
                predicate = texts[predicate].replace(" ", "_")
            return Application(predicate, tuple(_fill(each, texts) for each in arguments))
        case Wildcard() | Nonterminal() if key_of(form) in texts:
            return Constant(texts[key_of(form)])
        case _:
            return form


def _slots(form: Form) -> Iterator[Slot]:
    for node in walk(form):
        if isinstance(node, Application) and isinstance(node.predicate, Nonterminal):
            yield node.predicate
        elif isinstance(node, Nonterminal | Wildcard):
            yield node


def _exchange(slot: Slot, slots: Mapping[Key, Slot]) -> Slot:
    return slots.get(key_of(slot)) or absent(slot)


def _is_absent(symbol: object) -> bool:
    return isinstance(symbol, Nonterminal) and symbol.name.startswith("absent ")


def _keep(forms: tuple[Form, ...]) -> tuple[Form, ...]:
    return tuple(form for form in map(drop_absent, forms) if form is not None)
