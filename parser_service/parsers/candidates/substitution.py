"""Declared predicates in place of others of the same kind and signature.

Closure exchanges what it has seen. A world also declares predicates that no training form has; they
can replace a predicate of the same kind and signature.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache

from annotations.language.forms import to_corpus
from annotations.language.predicates import Predicate, signature_of
from parser_service.parsers.candidates.closure import Change, close
from parser_service.parsers.candidates.contexts import Contexts, Place, is_leaf
from parser_service.parsers.candidates.pool import SURE, Made
from parser_service.parsers.interface import Check, keep_going

NAME = "substitution"


def substitute(
    forms: Sequence[str], predicates: Mapping[str, Predicate], check: Check = keep_going
) -> list[Made]:
    """Return the forms with one description replaced by another declared one.

    No other change arrives at a description that none of ``forms`` has, so such a form counts as
    much as one that two kinds of change arrive at.
    """
    all_forms = "\n".join(forms)
    is_shown = cache(lambda description: description in all_forms)
    return [
        each if is_shown(_new_description(each)) else replace(each, weight=SURE)
        for each in close(forms, predicates, {NAME: rename}, check)
    ]


def rename(
    place: Place, contexts: Contexts, predicates: Mapping[str, Predicate]
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
            yield renamed, f"{to_corpus(part)} → {to_corpus(renamed)}"


def _new_description(made: Made) -> str:
    """Return the description that was put in, as its form writes it but for the variable's number."""
    return made.change.rpartition(" → ")[2]
