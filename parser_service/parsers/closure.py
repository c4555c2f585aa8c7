"""Forms that are one typed change away from given forms.

Every change keeps to the contexts that it has seen: a predicate goes only where such a predicate was,
beside predicates that it was seen with, and with arguments that its signatures allow. That still
gives far more forms than people use. Those that several kinds of change arrive at are likely
(``pool.CandidateForm.support``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

from annotations.language.forms import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    canonical_text,
    free_variables,
    read_form,
    to_corpus,
)
from annotations.language.texts import LanguageError
from annotations.language.world import (
    ArgumentKind,
    Predicate,
    Signature,
    is_entity_kind,
    signature_of,
)
from parser_service.parsers.contexts import (
    Contexts,
    Subform,
    conjuncts,
    find_contexts,
    is_leaf,
    places,
    variables,
    with_children,
)
from parser_service.parsers.interface import Check, keep_going
from parser_service.parsers.pool import WayToForm
from parser_service.parsers.spreading import visiting_order

MOST_WAYS = 30_000  # of one closure, which takes about ten seconds

Change = tuple[Form, str]
Changes = Callable[[Subform, Contexts, Mapping[str, Predicate]], Iterator[Change]]


def close(
    forms: Sequence[str],
    predicates: Mapping[str, Predicate],
    changes: Mapping[str, Changes] | None = None,
    check: Check = keep_going,
) -> list[WayToForm]:
    """Return forms one change away from ``forms``, once for each way to them.

    Args:
        forms: canonical texts; a text that is not a form is skipped.
        predicates: with the signatures that a change may use.
        changes: kinds of change by name; those of this module by default.
        check: is called for each form.

    These are all such forms, unless there are more than ``MOST_WAYS`` ways: then those from as many of
    ``forms``, spread evenly over them, as it takes to find that many.
    """
    kinds = CHANGES if changes is None else changes
    read = list(read_forms(forms))
    contexts = find_contexts(read, check)
    ways: dict[int, list[WayToForm]] = {}
    number_of_ways = 0
    for at in visiting_order(len(read)):
        if number_of_ways >= MOST_WAYS:
            break
        check()
        ways[at] = _change(read[at], contexts, predicates, kinds)
        number_of_ways += len(ways[at])
    return [each for at in sorted(ways) for each in ways[at]]


def _change(
    form: Form,
    contexts: Contexts,
    predicates: Mapping[str, Predicate],
    kinds: Mapping[str, Changes],
) -> list[WayToForm]:
    """Return the forms one change away from ``form``, once for each way to them."""
    origin = canonical_text(form)
    made: dict[WayToForm, None] = {}
    for place in places(form):
        for name, changed in kinds.items():
            for part, change in changed(place, contexts, predicates):
                whole = place.rebuild(part)
                if not free_variables(whole):
                    made[WayToForm(canonical_text(whole), name, origin, change)] = None
    return list(made)


def exchange(
    place: Subform, contexts: Contexts, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Replace a description by another one of the same variables: ``male`` for ``female``."""
    for number, part in enumerate(conjuncts(place.part)):
        if is_leaf(part):
            others = _without(conjuncts(place.part), number)
            mine = variables(part)
            for leaf, its in contexts.leaves.items():
                is_like = its == mine and leaf != part
                if is_like and contexts.go_together(leaf, others):
                    parts = list(conjuncts(place.part))
                    parts[number] = leaf
                    yield with_children(place.part, parts), f"{to_corpus(part)} → {to_corpus(leaf)}"


def drop(
    place: Subform, contexts: Contexts, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Remove one description."""
    parts = conjuncts(place.part)
    for number, part in enumerate(parts):
        if is_leaf(part) and len(parts) > 1:
            yield with_children(place.part, _without(parts, number)), f"− {to_corpus(part)}"


def add(
    place: Subform, contexts: Contexts, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Add a description of a variable that is described already."""
    parts = conjuncts(place.part)
    described = {variables(part) for part in parts if is_leaf(part)}
    for leaf, its in contexts.leaves.items():
        if its in described and contexts.go_together(leaf, parts):
            yield with_children(place.part, (*parts, leaf)), f"+ {to_corpus(leaf)}"


def transplant(
    place: Subform, contexts: Contexts, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Replace what an action is done with by what a λ of another form describes."""
    if place.holder is None or not isinstance(place.part, Lambda):
        return
    for term in contexts.fitting(place.holder):
        if term != place.part:
            yield term, f"{to_corpus(place.part)} → {to_corpus(term)}"


def retype(
    place: Subform, contexts: Contexts, predicates: Mapping[str, Predicate]
) -> Iterator[Change]:
    """Change the kind of a constant, add one or remove one, as a signature of the predicate allows."""
    part = place.part
    if not isinstance(part, Application) or str(part.predicate) not in predicates:
        return
    given = signature_of(part)
    for declared in predicates[str(part.predicate)].signatures:
        for arguments in _retype_arguments(part, given, declared):
            other = replace(part, arguments=arguments)
            yield other, f"{to_corpus(part)} → {to_corpus(other)}"


CHANGES: dict[str, Changes] = {
    "exchange": exchange,
    "drop": drop,
    "add": add,
    "transplant": transplant,
    "retype": retype,
}


def _retype_arguments(
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


def constant_of(kind: str) -> Form | None:
    """Return what an anonymized form has for an argument of some kind; None where it has no constant."""
    if kind == ArgumentKind.UNKNOWN:
        return UNKNOWN
    return Constant(f"<{kind}>") if is_entity_kind(kind) else None


def read_forms(texts: Iterable[str]) -> Iterator[Form]:
    """Read the texts that are forms. Other texts can be answers, but cannot be changed."""
    for text in texts:
        with suppress(LanguageError):
            yield read_form(text)


def _without(parts: Sequence[Form], number: int) -> tuple[Form, ...]:
    return (*parts[:number], *parts[number + 1 :])
