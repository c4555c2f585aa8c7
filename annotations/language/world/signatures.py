"""What a predicate takes: the kinds of its arguments, and how people write them.

A signature is written ``(object, room?)``, one a line. ``?`` marks arguments at the end that may be missing,
so that this line stands for two signatures.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from annotations.language.forms import (
    DEFAULT_CLASSES,
    Application,
    Constant,
    EntityClasses,
    Form,
    Lambda,
    Unknown,
    Variable,
    Wildcard,
    is_token,
)
from annotations.language.texts import LanguageError, Position

MOST_ARGUMENTS = 20


class ArgumentKind(StrEnum):
    """The kinds of arguments that every world has, beside the classes of its entities.

    LAMBDA is what a λ describes, FORM an application, TEXT a name written out, ANY unrestricted. Any other
    kind of an argument is the token of a class: it stands for a class token or a wildcard of that class.
    """

    VARIABLE = "variable"
    LAMBDA = "lambda"
    FORM = "form"
    NUMBER = "number"
    TEXT = "text"
    UNKNOWN = "unknown"
    ANY = "any"


_STRUCTURAL = frozenset(map(str, ArgumentKind))


def is_entity_kind(kind: str) -> bool:
    """Return whether a kind of argument is a class of entities."""
    return kind not in _STRUCTURAL


def known_kinds(classes: EntityClasses) -> tuple[str, ...]:
    """Return the kinds of arguments that a world with these classes has."""
    return (*map(str, ArgumentKind), *classes.tokens)


def admits(declared: str, given: str) -> bool:
    """Return whether an argument of kind ``given`` is allowed where a kind is declared.

    A written-out text may be an entity of any class, and where texts are allowed, tokens are too.
    """
    if ArgumentKind.ANY in (declared, given) or declared == given:
        return True
    if declared == ArgumentKind.TEXT:
        return is_entity_kind(given)
    return given == ArgumentKind.TEXT and is_entity_kind(declared)


_OF_TYPE = {
    Variable: ArgumentKind.VARIABLE,
    Lambda: ArgumentKind.LAMBDA,
    Application: ArgumentKind.FORM,
    Unknown: ArgumentKind.UNKNOWN,
}


@dataclass(frozen=True, slots=True, order=True)
class Signature:
    """The kinds of the arguments of a predicate, in order. An overloaded predicate has several.

    A kind is an ``ArgumentKind`` or the token of a class of entities.
    """

    arguments: tuple[str, ...]

    def __str__(self) -> str:
        return f"({', '.join(self.arguments)})"

    def within(self, classes: EntityClasses) -> Signature:
        """Return the signature with TEXT for the tokens that are of none of the classes."""
        known = known_kinds(classes)
        kinds = (each if each in known else ArgumentKind.TEXT for each in self.arguments)
        return Signature(tuple(kinds))

    def mismatches(self, given: Signature) -> tuple[int, ...]:
        """Return the places (from 0) where ``given``, of the same length, is not allowed."""
        pairs = zip(self.arguments, given.arguments, strict=True)
        return tuple(place for place, (mine, its) in enumerate(pairs) if not admits(mine, its))


def argument_kind(form: Form) -> str:
    """Return the kind of a form as an argument."""
    if isinstance(form, Constant):
        if isinstance(form.value, int):
            return ArgumentKind.NUMBER
        return form.token_class if is_token(form.token_class) else ArgumentKind.TEXT
    if isinstance(form, Wildcard) and form.entity_class:
        return form.entity_class
    return _OF_TYPE.get(type(form), ArgumentKind.ANY)


def signature_of(application: Application) -> Signature:
    """Return the signature that an application uses."""
    return Signature(tuple(map(argument_kind, application.arguments)))


def print_signatures(signatures: Iterable[Signature]) -> str:
    """Return the lines that read back as the same signatures."""
    left = set(signatures)
    lines: list[tuple[tuple[str, ...], str]] = []
    while left:
        longest = max(left, key=lambda each: (len(each.arguments), each))
        kinds = longest.arguments
        least = len(kinds)
        while least and Signature(kinds[: least - 1]) in left:
            least -= 1
        left -= {Signature(kinds[:length]) for length in range(least, len(kinds) + 1)}
        words = [str(kind) + "?" * (place >= least) for place, kind in enumerate(kinds)]
        lines.append((kinds, f"({', '.join(words)})"))
    return "\n".join(line for _, line in sorted(lines))


def read_signatures(text: str, classes: EntityClasses = DEFAULT_CLASSES) -> tuple[Signature, ...]:
    """Read what ``print_signatures`` writes; the parentheses may be missing around arguments.

    Args:
        classes: those that an argument may be of.

    Raises:
        LanguageError: with the line, for an unknown kind or a misplaced question mark.
    """
    signatures: set[Signature] = set()
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip():
            signatures |= _read_line(line, Position("", number), classes)
    return tuple(sorted(signatures))


def _read_line(line: str, place: Position, classes: EntityClasses) -> set[Signature]:
    bare = line.strip()
    inside = bare[1:-1] if bare.startswith("(") and bare.endswith(")") else bare
    if "(" in inside or ")" in inside:
        raise LanguageError(
            f"line {place.line} is not a signature", place, "write (object, room?), one a line"
        )
    words = [word.strip() for word in inside.split(",")] if inside.strip() else []
    if len(words) > MOST_ARGUMENTS:
        raise LanguageError(
            f"line {place.line} has {len(words)} arguments", place, f"{MOST_ARGUMENTS} is the limit"
        )
    names = [word.removesuffix("?").strip() for word in words]
    known = known_kinds(classes)
    unknown = next((name for name in names if name not in known), None)
    if unknown is not None:
        raise LanguageError(
            f"there is no kind of argument {unknown[:40] or 'without a name'} (line {place.line})",
            place,
            f"the kinds are {', '.join(known)}",
        )
    kinds = tuple(names)
    optional = [word.endswith("?") for word in words]
    least = optional.index(True) if True in optional else len(words)
    if not all(optional[least:]):
        raise LanguageError(
            f"in line {place.line} an argument that may be missing is not at the end",
            place,
            "write a line for each way to use it",
        )
    return {Signature(kinds[:length]) for length in range(least, len(kinds) + 1)}
