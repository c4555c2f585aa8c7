"""Fill the slots of a template's form with what the nonterminals and wildcards became."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from annotations.language.forms import (
    SEQUENCE,
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Nonterminal,
    Text,
    Unknown,
    Wildcard,
    actions_of,
    print_symbol,
    read_wildcard,
)
from annotations.language.texts import MAX_PREDICATE, LanguageError

# Anonymized words, or the leaves with their wildcards.
Filler: TypeAlias = "tuple[str | Text | Wildcard, ...]"
_IN_BRACES = re.compile(r"\{[^{}]*\}")
_PREDICATE = re.compile(r"[^\W\d][\w-]*")

# The number of a line and what its own nonterminals became, in the order of its form. Of two forms for the same
# words the one with the greater precedence is kept, so that later lines win.
Precedence: TypeAlias = "tuple[Any, ...]"


@dataclass(frozen=True, slots=True)
class Composed:
    """What a nonterminal with lines became: the form of the line that was taken, with its slots filled."""

    form: Form
    precedence: Precedence
    _hash: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        # Once, since it looks through the whole form, and each command asks for it.
        object.__setattr__(self, "_hash", hash((self.form, self.precedence)))

    def __hash__(self) -> int:
        return self._hash


def precedence_of(value: tuple[str, ...] | Composed) -> Precedence:
    """Return what decides between two values of a nonterminal: lines, or the words."""
    return value.precedence if isinstance(value, Composed) else value


def fill_anonymized(form: Form, bindings: Mapping[str, tuple[str, ...] | Composed]) -> Form:
    """Return the form with what each nonterminal became, and the class token of each wildcard.

    A nonterminal became words, or the form of a line. A sequence in a sequence becomes one. Where a line says
    nothing (its form is UNKNOWN), the argument is left out, and the description that has it: ``(at $1 $where)``.

    Raises:
        LanguageError: the words for a predicate are not a name.
    """
    return _fill(form, {name: _argument(each) for name, each in bindings.items()}, True)


def fill_intact(form: Form, bindings: Mapping[str, tuple[Text | Wildcard, ...] | Composed]) -> Form:
    """Return the form with what each nonterminal became; wildcards stay as bare slots.

    A nonterminal that became words and wildcards is a constant with the wildcards in braces.
    """
    return _fill(form, {name: _argument(each) for name, each in bindings.items()}, False)


def map_slots(form: Form, change: Callable[[Wildcard], Wildcard]) -> Form:
    """Return the form with ``change`` of its wildcards, in order, also of those inside texts: "big {object 1}"."""
    match form:
        case Lambda(variable, type_, bodies):
            return Lambda(variable, type_, tuple(map_slots(body, change) for body in bodies))
        case Application(predicate, arguments):
            return Application(predicate, tuple(map_slots(each, change) for each in arguments))
        case Wildcard():
            return change(form)
        case Constant(value=str() as text) if "{" in text:
            changed = _IN_BRACES.sub(
                lambda match: print_symbol(change(read_wildcard(match[0]))), text
            )
            return Constant(changed)
    return form


def bare(wildcard: Wildcard) -> Wildcard:
    """Return the wildcard without condition and note, as a form contains it."""
    return Wildcard(wildcard.name, wildcard.type, wildcard.id, wildcard.obfuscated)


def _fill(form: Form, values: Mapping[str, Form | None], anonymize: bool) -> Form:
    match form:
        case Lambda(variable, type_, bodies):
            said = [body for body in bodies if not _is_silent(body, values)]
            filled = tuple(_fill(body, values, anonymize) for body in said)
            return Lambda(variable, type_, filled) if filled else UNKNOWN
        case Application(predicate, arguments):
            name = (
                _predicate(predicate, values) if isinstance(predicate, Nonterminal) else predicate
            )
            given = [each for each in arguments if not _is_left_out(each, values)]
            parts = [_fill(argument, values, anonymize) for argument in given]
            if name == SEQUENCE:
                parts = [part for argument in parts for part in actions_of(argument)]
            return Application(name, tuple(parts))
        case Nonterminal(name):
            return values[name] or UNKNOWN
        case Wildcard():
            return Constant(form.token) if anonymize else bare(form)
        case _:
            return form


def _is_left_out(form: Form, values: Mapping[str, Form | None]) -> bool:
    """Return whether a form is a nonterminal whose line says nothing."""
    return isinstance(form, Nonterminal) and values[form.name] is None


def _is_silent(body: Form, values: Mapping[str, Form | None]) -> bool:
    """Return whether a description lacks an argument, since a line says nothing."""
    return isinstance(body, Application) and any(
        _is_left_out(each, values) for each in body.arguments
    )


def _argument(leaves: Filler | Composed) -> Form | None:
    """Return words as one constant (a number if they are digits); no words are UNKNOWN, a line without a form None."""
    if isinstance(leaves, Composed):
        return None if isinstance(leaves.form, Unknown) else leaves.form
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


def _predicate(slot: Nonterminal, values: Mapping[str, Form | None]) -> str:
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
