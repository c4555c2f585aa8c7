"""Fills the slots of a template's form with what the nonterminals and wildcards became."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TypeAlias

from annotations.language.errors import LanguageError
from annotations.language.logic import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
)
from annotations.language.printing import print_symbol
from annotations.language.symbols import Nonterminal, Text, Wildcard

# Anonymized words, or the leaves with their wildcards.
Filler: TypeAlias = "tuple[str | Text | Wildcard, ...]"
_PREDICATE = re.compile(r"[^\W\d][\w-]*")


def fill_anonymized(form: Form, bindings: Mapping[str, tuple[str, ...]]) -> Form:
    """The form with each nonterminal as its words and each wildcard as its class token.

    Raises:
        LanguageError: what stands for a predicate is no name.
    """
    return _filled(form, {name: _argument(words) for name, words in bindings.items()}, True)


def fill_intact(form: Form, bindings: Mapping[str, tuple[Text | Wildcard, ...]]) -> Form:
    """The form with each nonterminal as its words or its wildcard, wildcards left as bare slots.

    A nonterminal that became words and wildcards together is a constant in which the wildcards
    stand in braces.
    """
    return _filled(form, {name: _argument(leaves) for name, leaves in bindings.items()}, False)


def bare(wildcard: Wildcard) -> Wildcard:
    """The wildcard without condition and note, as it stands in a form."""
    return Wildcard(wildcard.name, wildcard.type, wildcard.id, wildcard.obfuscated)


def _filled(form: Form, values: Mapping[str, Form], anonymize: bool) -> Form:
    match form:
        case Lambda(variable, type_, bodies):
            return Lambda(
                variable, type_, tuple(_filled(body, values, anonymize) for body in bodies)
            )
        case Application(predicate, arguments):
            name = (
                _predicate(predicate, values) if isinstance(predicate, Nonterminal) else predicate
            )
            filled = (_filled(argument, values, anonymize) for argument in arguments)
            return Application(name, tuple(filled))
        case Nonterminal(name):
            return values[name]
        case Wildcard():
            return Constant(form.token) if anonymize else bare(form)
        case _:
            return form


def _argument(leaves: Filler) -> Form:
    """Words become one constant (a number where they are digits); no words are UNKNOWN."""
    spoken = [leaf for leaf in leaves if not (isinstance(leaf, Wildcard) and leaf.kind == "void")]
    if len(spoken) == 1 and isinstance(spoken[0], Wildcard):
        return bare(spoken[0])
    text = " ".join(_word(leaf) for leaf in spoken)
    if not text:
        return UNKNOWN
    return Constant(int(text) if re.fullmatch("[0-9]{1,9}", text) else text)


def _word(leaf: str | Text | Wildcard) -> str:
    if isinstance(leaf, Wildcard):
        return print_symbol(bare(leaf))
    return leaf if isinstance(leaf, str) else leaf.value


def _predicate(slot: Nonterminal, values: Mapping[str, Form]) -> str:
    value = values[slot.name]
    name = str(value.value).replace(" ", "_") if isinstance(value, Constant) else ""
    if _PREDICATE.fullmatch(name) is None:
        became = f'"{value.value}"' if isinstance(value, Constant) else "no words"
        raise LanguageError(
            f"${slot.name} stands for a predicate but became {became}",
            hint="a predicate is one name; spaces in it become underscores",
        )
    return name
