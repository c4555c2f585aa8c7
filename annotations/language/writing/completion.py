"""What can be written in a template of a task category: nonterminals, wildcards and predicates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from annotations.language.grammar import Grammar
from annotations.language.predicates import Predicate, PredicateKind
from annotations.language.symbols import (
    WILDCARD_NAMES,
    Symbols,
    Wildcard,
    print_sequence,
    print_wildcard,
    walk,
)
from annotations.language.templates import bare

SHOWN_ALTERNATIVES = 4
LONGEST_DETAIL = 80  # characters

_MEANINGS = {
    "object": "the name of an object",
    "category": "the name of an object category",
    "name": "the name of a person",
    "location": "the name of a location",
    "room": "the name of a room",
    "gesture": "a gesture",
    "question": "a question",
    "whattosay": "something to say",
}
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


def completions(grammar: Grammar, predicates: Mapping[str, Predicate]) -> Completions:
    """Return what the templates of a task category can say.

    Wildcards are those of the grammar with their numbers, and one of each kind.
    """
    written = {
        symbol
        for alternatives in grammar.rules.values()
        for alternative in alternatives
        for symbol in walk(alternative, notes=False)
        if isinstance(symbol, Wildcard)
    }
    plain = {bare(each) for each in written} | {Wildcard(name) for name in WILDCARD_NAMES}
    return Completions(
        tuple(_nonterminal(name, grammar.rules[name]) for name in sorted(grammar.rules)),
        tuple(map(_wildcard, sorted(plain, key=print_wildcard))),
        tuple(map(_wildcard, sorted(written - plain, key=print_wildcard))),
        tuple(_predicate(predicates[name]) for name in sorted(predicates)),
    )


def _nonterminal(name: str, alternatives: tuple[Symbols, ...]) -> Completion:
    shown = " | ".join(print_sequence(each) for each in alternatives[:SHOWN_ALTERNATIVES])
    more = len(alternatives) - SHOWN_ALTERNATIVES
    info = f"{shown} and {more} more" if more > 0 else shown
    return Completion(f"${name}", _shorten(shown), info)


def _wildcard(wildcard: Wildcard) -> Completion:
    return Completion(print_wildcard(wildcard), _meaning(wildcard), _more(wildcard))


def _meaning(wildcard: Wildcard) -> str:
    if wildcard.kind == "pron":
        return "a pronoun for who or what was named last"
    if wildcard.kind == "void":
        return "no words, only a note for the referee"
    meaning = _MEANINGS[wildcard.entity_class]
    restriction = wildcard.restriction
    return f"{meaning} ({restriction})" if restriction not in ("", "room") else meaning


def _more(wildcard: Wildcard) -> str:
    """Say what the number, the condition and the note of a wildcard do."""
    said = []
    if wildcard.obfuscated:
        said.append("It is not said by its name: an object by its category, a place by its room.")
    if wildcard.id is not None:
        said.append("The same name and number again is the same value.")
    if wildcard.where is not None:
        said.append("Only what meets the condition.")
    if wildcard.meta:
        said.append("With a note for the referee.")
    return " ".join(said)


def _predicate(predicate: Predicate) -> Completion:
    signatures = " or ".join(map(str, predicate.signatures))
    says = f": “{predicate.gloss}”" if predicate.gloss else ""
    return Completion(
        predicate.name, _shorten(signatures), f"{_KINDS[predicate.kind]}{says}. Takes {signatures}."
    )


def _shorten(text: str) -> str:
    return text if len(text) <= LONGEST_DETAIL else f"{text[: LONGEST_DETAIL - 1]}…"
