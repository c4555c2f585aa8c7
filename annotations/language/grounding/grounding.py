"""Ground a command with wildcards and its form in an ontology, with the notes for the referee."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count
from random import Random
from typing import TypeAlias

from annotations.language.forms import (
    PERSON_CLASS,
    PLACE_CLASS,
    QUESTION_CLASS,
    ROOM_CLASS,
    THING_CLASS,
    Application,
    Choice,
    Constant,
    Form,
    Lambda,
    Symbol,
    Symbols,
    Text,
    Wildcard,
    read_wildcard,
)
from annotations.language.grammar import anonymized
from annotations.language.grounding.drawing import Drawn, draw, wildcards_in
from annotations.language.texts import OBFUSCATED, PRONOUNS
from annotations.language.world import Entity, Ontology

Leaves: TypeAlias = "tuple[Text | Wildcard, ...]"

_PRONOUN_TYPES = {"": "obj", "paj": "pos", "posadj": "pos", "posabs": "pab"}
_IN_BRACES = re.compile(r"\{[^{}]*\}")


@dataclass(frozen=True, slots=True)
class Grounded:
    """A command in words, its form with the same entities, its anonymized text and its notes.

    ``values`` lists each wildcard once, bare and in order of appearance, with its entity.
    """

    text: str
    form: Form
    anonymized_text: str
    notes: tuple[str, ...]
    values: tuple[tuple[Wildcard, Entity], ...]


def ground(symbols: Symbols, form: Form, ontology: Ontology, random: Random) -> Grounded:
    """Fill every wildcard of a derivation with an entity.

    Wildcards with the same name and number have the same value; all others differ. ``{x?}`` says
    the obfuscated value; a pronoun refers to the last name before it, or else to the last wildcard;
    ``{void}`` says nothing; notes become ``Grounded.notes``.

    Args:
        symbols: words and wildcards; notes may hold choices; one alternative is taken.
        form: with bare wildcards, those without a number in the order of the command.
        random: the only source of randomness; equal seeds give equal results.

    Raises:
        LanguageError: the ontology has no value, or too few, for what is asked.
    """
    numbered = _number(_resolve(symbols, random), count(-1, -1))
    drawn = draw(_wildcards(numbered), ontology, random)
    speaker = _Speaker(drawn, ontology)
    words = [word for symbol in numbered if (word := speaker.say(symbol))]
    filled = speaker.fill(form, _Numbers(numbered))
    values = {each.identity: each for each in numbered if isinstance(each, Wildcard)}
    return Grounded(
        " ".join(words),
        filled,
        " ".join(word for each in numbered for word in anonymized(each)),
        tuple(speaker.notes),
        tuple(
            (replace(each, where=None, meta=()), drawn[key])
            for key, each in values.items()
            if key in drawn
        ),
    )


def _resolve(symbols: Symbols, random: Random) -> Leaves:
    """Take one alternative of each choice, also in notes; a nonterminal left in a note becomes a word."""
    resolved: list[Text | Wildcard] = []
    for symbol in symbols:
        match symbol:
            case Choice(alternatives):
                resolved += _resolve(random.choice(alternatives), random)
            case Wildcard(meta=meta):
                resolved.append(replace(symbol, meta=_resolve(meta, random)))
            case Text():
                resolved.append(symbol)
            case _:
                resolved.append(Text(str(symbol)))
    return tuple(resolved)


def _number(symbols: Symbols, numbers: Iterator[int]) -> Leaves:
    """Give each wildcard without a number a negative one of its own, so that identities differ."""
    numbered: list[Text | Wildcard] = []
    for symbol in symbols:
        if isinstance(symbol, Wildcard):
            number = next(numbers) if symbol.id is None else symbol.id
            numbered.append(replace(symbol, id=number, meta=_number(symbol.meta, numbers)))
        elif isinstance(symbol, Text):
            numbered.append(symbol)
    return tuple(numbered)


def _wildcards(symbols: Symbols) -> Iterator[Wildcard]:
    """Yield every wildcard that needs a value, including those in notes and conditions."""
    for symbol in symbols:
        if isinstance(symbol, Wildcard):
            yield symbol
            yield from _wildcards(tuple(wildcards_in(symbol.where)))
            yield from _wildcards(symbol.meta)


class _Numbers:
    """Finds the number of a form's wildcard: its own, or that of the next one in the command."""

    def __init__(self, symbols: Symbols) -> None:
        self._given: defaultdict[str, list[int | None]] = defaultdict(list)
        self._used: Counter[str] = Counter()
        for symbol in symbols:
            if isinstance(symbol, Wildcard) and symbol.id is not None and symbol.id < 0:
                self._given[symbol.name].append(symbol.id)

    def of(self, wildcard: Wildcard) -> Wildcard:
        given = self._given[wildcard.name]
        if wildcard.id is not None or not given:
            return wildcard
        turn = min(self._used[wildcard.name], len(given) - 1)
        self._used[wildcard.name] += 1
        return replace(wildcard, id=given[turn])


class _Speaker:
    """Says symbols in order and remembers what a pronoun refers to."""

    def __init__(self, drawn: Drawn, ontology: Ontology) -> None:
        self._drawn = drawn
        self._ontology = ontology
        self._last: Wildcard | None = None
        self._last_name: Wildcard | None = None
        self.notes: list[str] = []

    def say(self, symbol: Symbol) -> str:
        """Return the words of a symbol; its note is added to ``notes``."""
        if not isinstance(symbol, Wildcard):
            return symbol.value if isinstance(symbol, Text) else ""
        if symbol.entity_class:
            self._last = symbol
            self._last_name = symbol if symbol.kind == PERSON_CLASS else self._last_name
        words = self._words(symbol)
        if symbol.kind == QUESTION_CLASS:
            asked = self._drawn[symbol.identity]
            self.notes.append(f"Q: {asked.text} A: {asked.attribute('answer') or ''}".strip())
        if symbol.meta:
            said = " ".join(word for each in symbol.meta if (word := self.say(each)))
            self.notes.append(said.replace(" ,", ","))
        return words

    def fill(self, form: Form, numbers: _Numbers) -> Form:
        """Return the form with entities for its wildcards."""
        if isinstance(form, Lambda):
            return replace(form, bodies=tuple(self.fill(each, numbers) for each in form.bodies))
        if isinstance(form, Application):
            arguments = tuple(self.fill(each, numbers) for each in form.arguments)
            return replace(form, arguments=arguments)
        if isinstance(form, Wildcard):
            return Constant(self._value(numbers.of(form)))
        if isinstance(form, Constant) and isinstance(form.value, str) and "{" in form.value:
            return Constant(
                _IN_BRACES.sub(
                    lambda match: self._value(numbers.of(read_wildcard(match[0]))), form.value
                )
            )
        return form

    def _value(self, wildcard: Wildcard) -> str:
        """Return what a form says for a wildcard; a pronoun gives what it refers to."""
        if wildcard.kind == "pron":
            referent = self._last_name or self._last
            return self._words(referent) if referent else "them"
        if wildcard.identity not in self._drawn:
            return wildcard.token
        return self._words(wildcard)

    def _words(self, wildcard: Wildcard) -> str:
        if wildcard.kind == "void":
            return ""
        if wildcard.kind == "pron":
            type_ = _PRONOUN_TYPES.get(wildcard.type, wildcard.type)
            return PRONOUNS[self._gender()][type_]
        if wildcard.kind == QUESTION_CLASS:
            return QUESTION_CLASS
        entity = self._drawn[wildcard.identity]
        if not wildcard.obfuscated:
            return entity.text
        if wildcard.entity_class == THING_CLASS:
            return self._ontology.singular(entity.attribute("category") or THING_CLASS)
        if wildcard.entity_class == PLACE_CLASS:
            return entity.attribute("room") or ROOM_CLASS
        said = OBFUSCATED.get(wildcard.entity_class)
        return said or self._ontology.classes.singular(wildcard.entity_class)

    def _gender(self) -> str:
        """Return the gender for a pronoun.

        A name of both genders gives "them", like every pronoun of the published corpus.
        """
        if self._last_name is None:
            return "either" if self._last is None else "thing"
        text = self._drawn[self._last_name.identity].text
        rows = [each for each in self._ontology.of_class(PERSON_CLASS) if each.text == text]
        genders = {(each.attribute("gender") or "female").lower() for each in rows}
        return genders.pop() if len(genders) == 1 and genders <= PRONOUNS.keys() else "either"
