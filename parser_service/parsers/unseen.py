"""Declared predicates and signatures that no training form has, where their kind may occur.

Closure exchanges what training shows. A world also declares predicates that no training form has: they can
replace a predicate of the same kind and signature (``substitute``), or stand where their kind may
(``unseen``), as ``(leftmost $1 <location>)`` where training shows nothing like it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial

from annotations.language.forms import (
    Application,
    Form,
    Lambda,
    children,
    free_variables,
    to_corpus,
)
from annotations.language.world import (
    ArgumentKind,
    Predicate,
    PredicateKind,
    Signature,
    argument_kind,
    infer_signatures,
    signature_of,
)
from parser_service.parsers.closure import Change, close, constant_of, read_forms, retype
from parser_service.parsers.contexts import (
    Contexts,
    Subform,
    conjuncts,
    is_leaf,
    variables,
    with_children,
)
from parser_service.parsers.interface import Check, keep_going
from parser_service.parsers.pool import SURE, WayToForm

SUBSTITUTION, UNSEEN = "substitution", "unseen"  # the names of the steps
OPEN_KINDS = (ArgumentKind.LAMBDA, ArgumentKind.VARIABLE)


def substitute(
    forms: Sequence[str], predicates: Mapping[str, Predicate], check: Check = keep_going
) -> list[WayToForm]:
    """Return the forms with one description replaced by another declared one.

    No other change arrives at a description that none of ``forms`` has, so such a form counts as
    much as one that two kinds of change arrive at.
    """
    all_forms = "\n".join(forms)
    is_shown = cache(lambda description: description in all_forms)
    made = []
    for way in close(forms, predicates, {SUBSTITUTION: rename}, check):
        # The description that was put in, as its form writes it but for the variable's number.
        _, _, description = way.change.rpartition(" → ")
        made.append(way if is_shown(description) else replace(way, weight=SURE))
    return made


def rename(
    place: Subform, contexts: Contexts, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Replace a description by one that takes the same arguments: ``right_of`` for ``left_of``."""
    part = place.part
    if not is_leaf(part):
        return
    mine = predicates.get(str(part.predicate))
    given = signature_of(part)
    for other in predicates.values():
        is_like = mine is not None and other.kind == mine.kind and given in other.signatures
        if is_like and other.name != part.predicate:
            renamed = replace(part, predicate=other.name)
            yield renamed, _describe_change(part, renamed)


def unseen(
    forms: Sequence[str], predicates: Mapping[str, Predicate], check: Check = keep_going
) -> list[WayToForm]:
    """Return the forms with one predicate that none of ``forms`` has, or has with such arguments.

    Few other changes arrive at them, so each counts as much as one that two kinds arrive at.
    """
    shown = infer_signatures(read_forms(forms))
    absent = {name: each for name, each in predicates.items() if name not in shown}
    other = {
        name: replace(
            predicate,
            signatures=tuple(s for s in predicate.signatures if s not in shown[name].signatures),
        )
        for name, predicate in predicates.items()
        if name in shown
    }
    of_kind = {name for name, each in predicates.items() if each.kind is PredicateKind.SEQUENCE}
    made = [
        *close(forms, absent, {UNSEEN: partial(stand_in, sequences=of_kind)}, check),
        *close(forms, other, {UNSEEN: retype}, check),
    ]
    return [replace(each, weight=SURE) for each in made]


def stand_in(
    place: Subform,
    contexts: Contexts,
    predicates: Mapping[str, Predicate],
    sequences: Collection[str] = (),
) -> Iterator[Change]:
    """Put one of ``predicates`` in place of an action, or of a description that is the only one.

    ``sequences`` names the predicates whose arguments are actions."""
    parts = conjuncts(place.part)
    is_action = place.holder is None or place.holder[0] in sequences
    if is_action and not free_variables(place.part):
        # Other actions on the first things that this one is done with.
        things = [each for each in children(place.part) if isinstance(each, Lambda)]
        for number in range(len(things) + 1):
            for action in _instances(PredicateKind.ACTION, things[:number], predicates):
                yield action, _describe_change(place.part, action)
    elif len(parts) == 1 and is_leaf(parts[0]):
        for leaf in _instances(PredicateKind.DESCRIPTION, variables(parts[0]), predicates):
            yield with_children(place.part, [leaf]), _describe_change(parts[0], leaf)


def _instances(
    kind: PredicateKind, kept: Sequence[Form], predicates: Mapping[str, Predicate]
) -> Iterator[Application]:
    """Yield the applications of ``predicates`` to ``kept``, in this order, and to constants."""
    for predicate in predicates.values():
        for signature in predicate.signatures if predicate.kind == kind else ():
            if (arguments := _arguments(signature, kept)) is not None:
                yield Application(predicate.name, arguments)


def _arguments(signature: Signature, kept: Sequence[Form]) -> tuple[Form, ...] | None:
    """Return ``kept`` where λs and variables are declared, constants elsewhere; None where they do not fit."""
    wanted = [kind for kind in signature.arguments if kind in OPEN_KINDS]
    if [argument_kind(each) for each in kept] != wanted:
        return None
    left = iter(kept)
    arguments = []
    for kind in signature.arguments:
        argument = next(left) if kind in OPEN_KINDS else constant_of(kind)
        if argument is None:
            return None
        arguments.append(argument)
    return tuple(arguments)


def _describe_change(given: Form, other: Form) -> str:
    return f"{to_corpus(given)} → {to_corpus(other)}"
