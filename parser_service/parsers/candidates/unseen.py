"""Declared predicates and signatures that no training form has, where their kind may occur.

Closure exchanges what training shows, and ``substitution`` needs another predicate of the same
signature. A world may also declare ``(leftmost $1 <location>)`` where training shows nothing like it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

from annotations.language.forms import (
    Application,
    Form,
    Lambda,
    children,
    free_variables,
    to_corpus,
)
from annotations.language.predicates import (
    ArgumentKind,
    Predicate,
    PredicateKind,
    Signature,
    argument_kind,
    infer_signatures,
)
from parser_service.parsers.candidates.closure import Change, close, constant_of, read_forms, retype
from parser_service.parsers.candidates.contexts import (
    Contexts,
    Place,
    conjuncts,
    is_leaf,
    variables,
    with_children,
)
from parser_service.parsers.candidates.pool import SURE, Made
from parser_service.parsers.interface import Check, keep_going

NAME = "unseen"
OPEN_KINDS = (ArgumentKind.LAMBDA, ArgumentKind.VARIABLE)


def unseen(
    forms: Sequence[str], predicates: Mapping[str, Predicate], check: Check = keep_going
) -> list[Made]:
    """Return the forms with one predicate that none of ``forms`` has, or has with such arguments.

    Few other changes arrive at them, so each counts as much as one that two kinds arrive at.
    """
    shown = infer_signatures(read_forms(forms))
    absent = {name: each for name, each in predicates.items() if name not in shown}
    other = {
        name: replace(each, signatures=_without(each.signatures, shown[name].signatures))
        for name, each in predicates.items()
        if name in shown
    }
    of_kind = {name for name, each in predicates.items() if each.kind is PredicateKind.SEQUENCE}
    made = [
        *close(forms, absent, {NAME: partial(stand_in, sequences=of_kind)}, check),
        *close(forms, other, {NAME: retype}, check),
    ]
    return [replace(each, weight=SURE) for each in made]


def stand_in(
    place: Place,
    contexts: Contexts,
    predicates: Mapping[str, Predicate],
    sequences: Collection[str] = (),
) -> Iterator[Change]:
    """Put one of ``predicates`` in place of an action, or of a description that is the only one.

    ``sequences`` names the predicates whose arguments are actions."""
    parts = conjuncts(place.part)
    if _is_action(place, sequences):
        yield from _actions(place.part, predicates)
    elif len(parts) == 1 and is_leaf(parts[0]):
        for leaf in _instances(PredicateKind.DESCRIPTION, variables(parts[0]), predicates):
            yield with_children(place.part, [leaf]), _describe_change(parts[0], leaf)


def _without(declared: Sequence[Signature], shown: Sequence[Signature]) -> tuple[Signature, ...]:
    return tuple(each for each in declared if each not in shown)


def _is_action(place: Place, sequences: Collection[str]) -> bool:
    """Return whether the part is an action, by itself or in a sequence."""
    is_one = place.holder is None or place.holder[0] in sequences
    return is_one and not free_variables(place.part)


def _actions(form: Form, predicates: Mapping[str, Predicate]) -> Iterator[Change]:
    """Yield other actions on the first things that the action ``form`` is done with."""
    things = [each for each in children(form) if isinstance(each, Lambda)]
    for number in range(len(things) + 1):
        for action in _instances(PredicateKind.ACTION, things[:number], predicates):
            yield action, _describe_change(form, action)


def _instances(
    kind: PredicateKind, kept: Sequence[Form], predicates: Mapping[str, Predicate]
) -> Iterator[Application]:
    """Yield the applications of ``predicates`` to ``kept``, in this order, and to constants."""
    for each in predicates.values():
        for signature in each.signatures if each.kind == kind else ():
            if (arguments := _arguments(signature, kept)) is not None:
                yield Application(each.name, arguments)


def _arguments(signature: Signature, kept: Sequence[Form]) -> tuple[Form, ...] | None:
    """Return ``kept`` where λs and variables are declared, constants elsewhere; None where they do not fit."""
    wanted = [kind for kind in signature.arguments if kind in OPEN_KINDS]
    if [argument_kind(each) for each in kept] != wanted:
        return None
    left = iter(kept)
    arguments = [
        next(left) if kind in OPEN_KINDS else constant_of(kind) for kind in signature.arguments
    ]
    return None if None in arguments else tuple(arguments)


def _describe_change(given: Form, other: Form) -> str:
    return f"{to_corpus(given)} → {to_corpus(other)}"
