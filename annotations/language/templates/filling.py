"""Fill the slots of a template's form with what the nonterminals and wildcards became."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TypeAlias

from annotations.language.errors import LanguageError
from annotations.language.forms import UNKNOWN, Application, Constant, Form, Lambda
from annotations.language.limits import MAX_PREDICATE
from annotations.language.symbols import Nonterminal, Text, Wildcard, print_symbol

# Anonymized words, or the leaves with their wildcards.
Filler: TypeAlias = "tuple[str | Text | Wildcard, ...]"
_PREDICATE = re.compile(r"[^\W\d][\w-]*")


def fill_anonymized(form: Form, bindings: Mapping[str, tuple[str, ...]]) -> Form:
    """Return the form with the words of each nonterminal and the class token of each wildcard.

    Raises:
        LanguageError: the words for a predicate are not a name.
    """
    return _fill(form, {name: _argument(words) for name, words in bindings.items()}, True)


def fill_intact(form: Form, bindings: Mapping[str, tuple[Text | Wildcard, ...]]) -> Form:
    """Return the form with the words or the wildcard of each nonterminal; wildcards stay as bare slots.

    A nonterminal that became words and wildcards is a constant with the wildcards in braces.
    """
    return _fill(form, {name: _argument(leaves) for name, leaves in bindings.items()}, False)


def bare(wildcard: Wildcard) -> Wildcard:
    """Return the wildcard without condition and note, as a form contains it."""
    return Wildcard(wildcard.name, wildcard.type, wildcard.id, wildcard.obfuscated)


def _fill(form: Form, values: Mapping[str, Form], anonymize: bool) -> Form:
    match form:
        case Lambda(variable, type_, bodies):
            return Lambda(variable, type_, tuple(_fill(body, values, anonymize) for body in bodies))
        case Application(predicate, arguments):
            name = (
                _predicate(predicate, values) if isinstance(predicate, Nonterminal) else predicate
            )
            filled = (_fill(argument, values, anonymize) for argument in arguments)
            return Application(name, tuple(filled))
        case Nonterminal(name):
            return values[name]
        case Wildcard():
            return Constant(form.token) if anonymize else bare(form)
        case _:
            return form


def _argument(leaves: Filler) -> Form:
    """Return words as one constant (a number if they are digits); no words are UNKNOWN."""
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
    if _PREDICATE.fullmatch(name) is None or len(name) > MAX_PREDICATE:
        became = f'"{value.value}"' if isinstance(value, Constant) else "no words"
        raise LanguageError(
            f"${slot.name} is used as a predicate but became {became}",
            hint=f"a predicate is one name of at most {MAX_PREDICATE} characters; "
            "spaces in it become underscores",
        )
    return name
