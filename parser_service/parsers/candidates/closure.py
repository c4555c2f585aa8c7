"""Forms that are one typed change away from forms there are.

Every step keeps to what it has seen: predicates stand where such predicates stood, beside those
that they stood beside, with arguments of a kind that their signatures have. That gives far more
forms than anybody says; those that several kinds of change arrive at are likely ones
(``pool.Candidate.support``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

from annotations.language.canonical import canonical_text
from annotations.language.errors import LanguageError
from annotations.language.logic import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    free_variables,
    read_form,
    to_corpus,
)
from annotations.language.predicates import Predicate
from annotations.language.signatures import ENTITY_KINDS, ArgumentKind, Signature, signature_of
from parser_service.parsers.candidates.pool import Made
from parser_service.parsers.candidates.surroundings import (
    Place,
    Surroundings,
    conjuncts,
    is_leaf,
    look_around,
    places,
    variables,
    with_children,
)

Change = tuple[Form, str]
Changes = Callable[[Place, Surroundings, Mapping[str, Predicate]], Iterator[Change]]


def close(
    forms: Sequence[str],
    predicates: Mapping[str, Predicate],
    changes: Mapping[str, Changes] | None = None,
) -> list[Made]:
    """Everything one change away from ``forms``, once for each way that leads there.

    Args:
        forms: canonical texts; one that is no form is left out.
        predicates: with the signatures that a change may use.
        changes: kinds of change by name, those of this module by default.
    """
    kinds = CHANGES if changes is None else changes
    read = list(read_forms(forms))
    around = look_around(read)
    made: dict[Made, None] = {}
    for form in read:
        origin = canonical_text(form)
        for place in places(form):
            for name, changed in kinds.items():
                for part, change in changed(place, around, predicates):
                    whole = place.rebuild(part)
                    if not free_variables(whole):
                        made[Made(canonical_text(whole), name, origin, change)] = None
    return list(made)


def exchange(
    place: Place, around: Surroundings, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Another description of the same variables: ``male`` for ``female``."""
    for number, part in enumerate(conjuncts(place.part)):
        if is_leaf(part):
            others = _without(conjuncts(place.part), number)
            for leaf in around.leaves:
                is_like = leaf != part and variables(leaf) == variables(part)
                if is_like and around.go_together(leaf, others):
                    parts = list(conjuncts(place.part))
                    parts[number] = leaf
                    yield with_children(place.part, parts), f"{_said(part)} → {_said(leaf)}"


def drop(
    place: Place, around: Surroundings, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """One description less."""
    parts = conjuncts(place.part)
    for number, part in enumerate(parts):
        if is_leaf(part) and len(parts) > 1:
            yield with_children(place.part, _without(parts, number)), f"− {_said(part)}"


def add(
    place: Place, around: Surroundings, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """One description more, of a variable that is described already."""
    parts = conjuncts(place.part)
    described = {variables(part) for part in parts if is_leaf(part)}
    for leaf in around.leaves:
        if variables(leaf) in described and around.go_together(leaf, parts):
            yield with_children(place.part, (*parts, leaf)), f"+ {_said(leaf)}"


def transplant(
    place: Place, around: Surroundings, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Another thing to do the same with: what a λ of another form describes."""
    if place.holder is None or not isinstance(place.part, Lambda):
        return
    for term in around.terms:
        if term != place.part and around.may_hold(place.holder, term):
            yield term, f"{_said(place.part)} → {_said(term)}"


def retype(
    place: Place, around: Surroundings, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """A constant of another kind, or one more or less, as a signature of the predicate allows."""
    part = place.part
    if not isinstance(part, Application) or str(part.predicate) not in predicates:
        return
    given = signature_of(part)
    for declared in predicates[str(part.predicate)].signatures:
        for arguments in _retyped(part, given, declared):
            other = replace(part, arguments=arguments)
            yield other, f"{_said(part)} → {_said(other)}"


CHANGES: dict[str, Changes] = {
    "exchange": exchange,
    "drop": drop,
    "add": add,
    "transplant": transplant,
    "retype": retype,
}


def _retyped(
    part: Application, given: Signature, declared: Signature
) -> Iterator[tuple[Form, ...]]:
    mine, its = given.arguments, declared.arguments
    if len(mine) == len(its):
        differing = [at for at, kind in enumerate(its) if kind != mine[at]]
        if len(differing) == 1 and (constant := constant_of(its[differing[0]])):
            [at] = differing
            yield (*part.arguments[:at], constant, *part.arguments[at + 1 :])
    elif its[:-1] == mine and (constant := constant_of(its[-1])):
        yield (*part.arguments, constant)
    elif its == mine[:-1]:
        yield part.arguments[:-1]


def constant_of(kind: ArgumentKind) -> Form | None:
    """What stands for an argument of some kind in an anonymized form."""
    if kind is ArgumentKind.UNKNOWN:
        return UNKNOWN
    return Constant(f"<{kind}>") if kind in ENTITY_KINDS else None


def read_forms(texts: Iterable[str]) -> Iterator[Form]:
    """The forms that can be changed: a text that is none can only be answered."""
    for text in texts:
        with suppress(LanguageError):
            yield read_form(text)


def _without(parts: Sequence[Form], number: int) -> tuple[Form, ...]:
    return (*parts[:number], *parts[number + 1 :])


def _said(form: Form) -> str:
    return to_corpus(form)
