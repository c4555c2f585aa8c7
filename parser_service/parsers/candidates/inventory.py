"""Predicates that may stand in for one another, whether training shows them or not.

Closure exchanges what it has seen. A world also declares predicates that no training form has; they
stand where a predicate of the same kind and signature stands.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from annotations.language.logic import to_corpus
from annotations.language.predicates import Predicate
from annotations.language.signatures import signature_of
from parser_service.parsers.candidates.closure import Change, close
from parser_service.parsers.candidates.pool import SURE, Made
from parser_service.parsers.candidates.surroundings import Place, Surroundings, is_leaf

NAME = "inventory"


def inventory(forms: Sequence[str], predicates: Mapping[str, Predicate]) -> list[Made]:
    """The forms with one description renamed to another declared one.

    A description that none of ``forms`` has cannot be arrived at in any other way, so that such a
    form is as sure as one by two kinds of change.
    """
    return [
        each if any(_new(each) in form for form in forms) else replace(each, weight=SURE)
        for each in close(forms, predicates, {NAME: rename})
    ]


def rename(
    place: Place, around: Surroundings, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Another description that takes the same arguments: ``right_of`` for ``left_of``."""
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


def _new(made: Made) -> str:
    """The description that came in, as its form writes it but for the number of its variable."""
    return made.change.rpartition(" → ")[2]
