"""What can be written in a template of a task category: nonterminals, wildcards and predicates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from annotations.language.forms import (
    DEFAULT_CLASSES,
    EntityClasses,
    Wildcard,
    print_sequence,
    print_wildcard,
    walk_symbols,
    wildcard_names,
)
from annotations.language.grammar import Grammar
from annotations.language.templates.candidates import shorten
from annotations.language.templates.filling import bare
from annotations.language.world import Predicate, PredicateKind

SHOWN_ALTERNATIVES = 4
LONGEST_DETAIL = 80  # characters

_KINDS = {
    PredicateKind.ACTION: "Something to do",
    PredicateKind.SEQUENCE: "Does its arguments, one after the other",
    PredicateKind.DESCRIPTION: "Says something of a variable",
}


@dataclass(frozen=True, slots=True)
class Completion:
    """A text that can be written, in a few words what it is, and a sentence or two about it."""

    text: str
    detail: str = ""
    info: str = ""


@dataclass(frozen=True, slots=True)
class Completions:
    """All that can be written, each kind by its text.

    ``conditions`` are wildcards with a condition or a note, which only a pattern writes.
    """

    nonterminals: tuple[Completion, ...]
    wildcards: tuple[Completion, ...]
    conditions: tuple[Completion, ...]
    predicates: tuple[Completion, ...]


def completions(
    grammar: Grammar,
    predicates: Mapping[str, Predicate],
    classes: EntityClasses = DEFAULT_CLASSES,
) -> Completions:
    """Return what the templates of a task category can say, in a world with these classes of entities.

    Wildcards are those of the grammar with their numbers, and one of each kind.
    """
    written = {
        symbol
        for alternatives in grammar.rules.values()
        for alternative in alternatives
        for symbol in walk_symbols(alternative, notes=False)
        if isinstance(symbol, Wildcard)
    }
    plain = {bare(each) for each in written} | {Wildcard(name) for name in wildcard_names(classes)}
    of_nonterminals: list[Completion] = []
    for name in sorted(grammar.rules):
        alternatives = grammar.rules[name]
        shown = " | ".join(map(print_sequence, alternatives[:SHOWN_ALTERNATIVES]))
        more = len(alternatives) - SHOWN_ALTERNATIVES
        info = f"{shown} and {more} more" if more > 0 else shown
        of_nonterminals.append(Completion(f"${name}", shorten(shown, LONGEST_DETAIL), info))
    of_predicates: list[Completion] = []
    for name in sorted(predicates):
        signatures = " or ".join(map(str, predicates[name].signatures))
        says = f": “{predicates[name].gloss}”" if predicates[name].gloss else ""
        info = f"{_KINDS[predicates[name].kind]}{says}. Takes {signatures}."
        of_predicates.append(Completion(name, shorten(signatures, LONGEST_DETAIL), info))
    return Completions(
        tuple(of_nonterminals),
        tuple(_wildcard(each, classes) for each in sorted(plain, key=print_wildcard)),
        tuple(_wildcard(each, classes) for each in sorted(written - plain, key=print_wildcard)),
        tuple(of_predicates),
    )


def _wildcard(wildcard: Wildcard, classes: EntityClasses) -> Completion:
    said = []
    if wildcard.obfuscated:
        said.append("It is not said by its name: an object by its category, a place by its room.")
    if wildcard.id is not None:
        said.append("The same name and number again is the same value.")
    if wildcard.where is not None:
        said.append("Only what meets the condition.")
    if wildcard.meta:
        said.append("With a note for the referee.")
    if wildcard.kind == "pron":
        meaning = "a pronoun for who or what was named last"
    elif wildcard.kind == "void":
        meaning = "no words, only a note for the referee"
    else:
        restriction = wildcard.restriction
        kind = f" ({restriction})" if restriction not in ("", "room") else ""
        meaning = f"one of the {classes.plural(wildcard.entity_class)}{kind}"
    return Completion(print_wildcard(wildcard), meaning, " ".join(said))
