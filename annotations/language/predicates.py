"""The predicates of a world: inferred from its forms, checked against them, glossed in English."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from enum import StrEnum

from annotations.language.errors import Position, Problem, warning
from annotations.language.gloss_patterns import default_pattern
from annotations.language.glossing import sentence
from annotations.language.logic import Application, Form, Lambda, Variable, children, walk
from annotations.language.signatures import ArgumentKind, Signature, argument_kind, signature_of

__all__ = [
    "ArgumentKind",
    "Predicate",
    "PredicateKind",
    "Signature",
    "argument_kind",
    "check_form",
    "gloss",
    "infer_signatures",
    "signature_of",
]


class PredicateKind(StrEnum):
    """An ACTION is something to do; a DESCRIPTION says something about what a variable stands for."""

    ACTION = "action"
    DESCRIPTION = "description"


@dataclass(frozen=True, slots=True)
class Predicate:
    """A name, what it takes (several signatures where it is overloaded) and its gloss pattern.

    The pattern is explained in ``gloss_patterns``.
    """

    name: str
    kind: PredicateKind
    signatures: tuple[Signature, ...]
    gloss: str = ""


def infer_signatures(forms: Iterable[Form]) -> dict[str, Predicate]:
    """The predicates that occur in the forms, by name and sorted by it, with default glosses.

    A predicate is an action where it heads a form, or stands in an action without having a variable
    as an argument itself (``(say (count …))``), or stands beside such a one in a sequence. All
    others are descriptions.
    """
    signatures: defaultdict[str, set[Signature]] = defaultdict(set)
    actions: set[str] = set()
    for form in dict.fromkeys(forms):
        actions.update(_actions(form))
        for application in _applications(form):
            signatures[str(application.predicate)].add(signature_of(application))
    return {
        name: _predicate(name, name in actions, tuple(sorted(signatures[name])))
        for name in sorted(signatures)
    }


def check_form(
    form: Form, predicates: Mapping[str, Predicate], position: Position | None = None
) -> list[Problem]:
    """Warnings, all at ``position``: unknown predicate, wrong arity, wrong kind of argument."""
    place = position or Position()
    found = (_problem(each, predicates, place) for each in _applications(form))
    return list(dict.fromkeys(problem for problem in found if problem))


def gloss(form: Form, predicates: Mapping[str, Predicate]) -> str:
    """A short English sentence for a form, the same on every call.

    ``( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )`` is "bring me the object". Predicates that
    are not declared are glossed by their names.
    """
    known = {**infer_signatures([form]), **predicates}
    patterns = {name: each.gloss or _default(each) for name, each in known.items()}
    actions = frozenset(n for n, each in known.items() if each.kind == PredicateKind.ACTION)
    return sentence(form, patterns, actions)


def _predicate(name: str, is_action: bool, signatures: tuple[Signature, ...]) -> Predicate:
    kind = PredicateKind.ACTION if is_action else PredicateKind.DESCRIPTION
    predicate = Predicate(name, kind, signatures)
    return replace(predicate, gloss=_default(predicate))


def _default(predicate: Predicate) -> str:
    is_action = predicate.kind == PredicateKind.ACTION
    return default_pattern(predicate.name, is_action, predicate.signatures)


def _applications(form: Form) -> Iterator[Application]:
    """Those with a predicate of their own: a nonterminal's is not known yet."""
    for node in walk(form):
        if isinstance(node, Application) and isinstance(node.predicate, str):
            yield node


def _actions(form: Form) -> Iterator[str]:
    """The predicates of a command that are to be done."""
    if isinstance(form, Lambda):
        for body in form.bodies:
            if isinstance(body, Lambda) or not _takes_variable(body):
                yield from _actions(body)
    elif isinstance(form, Application):
        yield str(form.predicate)
        inside = [each for each in form.arguments if isinstance(each, Application)]
        if not all(map(_takes_variable, inside)):
            for each in inside:
                yield from _actions(each)


def _takes_variable(form: Form) -> bool:
    return any(isinstance(argument, Variable) for argument in children(form))


def _problem(
    form: Application, predicates: Mapping[str, Predicate], position: Position
) -> Problem | None:
    name = str(form.predicate)
    if name not in predicates:
        close = get_close_matches(name, predicates, n=1)
        hint = f"did you mean {close[0]}?" if close else "declare it, or use one that is declared"
        return warning(position, f"there is no predicate {name}", hint)
    declared = predicates[name].signatures
    given = signature_of(form)
    choices = " or ".join(f"{name}{each}" for each in declared)
    candidates = [each for each in declared if len(each.arguments) == len(given.arguments)]
    if not candidates:
        message = f"{name} does not take {_counted(len(given.arguments))}"
        return warning(position, message, f"write {choices}" if choices else "declare a signature")
    places = min((each.mismatches(given) for each in candidates), key=len)
    if not places:
        return None
    kind = given.arguments[places[0]]
    message = f"argument {places[0] + 1} of {name} cannot be of the kind {kind}"
    return warning(position, message, f"write {choices}")


def _counted(arguments: int) -> str:
    return f"{arguments} argument{'' if arguments == 1 else 's'}"
