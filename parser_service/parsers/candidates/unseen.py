"""Declared predicates and signatures that no training form has, where they may stand.

What training shows can be exchanged for what it shows elsewhere, and ``inventory`` asks for another
predicate of the same signature. A world may also declare ``(leftmost $1 <location>)`` where nothing
like it was ever said.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from annotations.language.logic import (
    Application,
    Form,
    Lambda,
    children,
    free_variables,
    to_corpus,
)
from annotations.language.predicates import Predicate, PredicateKind, infer_signatures
from annotations.language.signatures import ArgumentKind, Signature, argument_kind
from parser_service.parsers.candidates.closure import Change, close, constant_of, read_forms, retype
from parser_service.parsers.candidates.pool import SURE, Made
from parser_service.parsers.candidates.surroundings import (
    Place,
    Surroundings,
    conjuncts,
    is_leaf,
    variables,
    with_children,
)

NAME = "unseen"
OPEN_KINDS = (ArgumentKind.LAMBDA, ArgumentKind.VARIABLE)


def unseen(forms: Sequence[str], predicates: Mapping[str, Predicate]) -> list[Made]:
    """The forms with one predicate that none of ``forms`` has, or none with such arguments.

    Little else arrives at them, so that each is as sure as one by two kinds of change.
    """
    shown = infer_signatures(read_forms(forms))
    absent = {name: each for name, each in predicates.items() if name not in shown}
    other = {
        name: replace(each, signatures=_without(each.signatures, shown[name].signatures))
        for name, each in predicates.items()
        if name in shown
    }
    made = [*close(forms, absent, {NAME: stand_in}), *close(forms, other, {NAME: retype})]
    return [replace(each, weight=SURE) for each in made]


def stand_in(
    place: Place, around: Surroundings, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """One of ``predicates`` in place of an action, or of a description that stands alone."""
    parts = conjuncts(place.part)
    if _is_done(place):
        yield from _actions(place.part, predicates)
    elif len(parts) == 1 and is_leaf(parts[0]):
        for leaf in _instances(PredicateKind.DESCRIPTION, variables(parts[0]), predicates):
            yield with_children(place.part, [leaf]), _said(parts[0], leaf)


def _without(declared: Sequence[Signature], shown: Sequence[Signature]) -> tuple[Signature, ...]:
    return tuple(each for each in declared if each not in shown)


def _is_done(place: Place) -> bool:
    """Whether an action stands there by itself or in a sequence."""
    return (place.holder is None or place.holder[0] == "sequence") and not free_variables(
        place.part
    )


def _actions(form: Form, predicates: Mapping[str, Predicate]) -> Iterator[Change]:
    """Other things to do with the first things that ``form`` does something with."""
    things = [each for each in children(form) if isinstance(each, Lambda)]
    for number in range(len(things) + 1):
        for action in _instances(PredicateKind.ACTION, things[:number], predicates):
            yield action, _said(form, action)


def _instances(
    kind: PredicateKind, kept: Sequence[Form], predicates: Mapping[str, Predicate]
) -> Iterator[Application]:
    """The applications that signatures allow to ``kept``, in its order, and to constants."""
    for each in predicates.values():
        for signature in each.signatures if each.kind == kind else ():
            if (arguments := _arguments(signature, kept)) is not None:
                yield Application(each.name, arguments)


def _arguments(signature: Signature, kept: Sequence[Form]) -> tuple[Form, ...] | None:
    """``kept`` where λs and variables are declared, constants elsewhere; None where that cannot be."""
    wanted = [kind for kind in signature.arguments if kind in OPEN_KINDS]
    if [argument_kind(each) for each in kept] != wanted:
        return None
    left = iter(kept)
    found = [
        next(left) if kind in OPEN_KINDS else constant_of(kind) for kind in signature.arguments
    ]
    return None if None in found else tuple(found)


def _said(given: Form, other: Form) -> str:
    return f"{to_corpus(given)} → {to_corpus(other)}"
