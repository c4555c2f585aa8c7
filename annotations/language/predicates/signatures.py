"""What a predicate takes: the kinds of its arguments."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from annotations.language.forms import Application, Constant, Form, Lambda, Unknown, Variable
from annotations.language.symbols import ENTITY_CLASSES, Wildcard


class ArgumentKind(StrEnum):
    """LAMBDA is what a λ describes, FORM an application, TEXT a name written out, ANY unrestricted.

    The entity classes stand for a class token or a wildcard of that class.
    """

    VARIABLE = "variable"
    LAMBDA = "lambda"
    FORM = "form"
    NUMBER = "number"
    TEXT = "text"
    UNKNOWN = "unknown"
    ANY = "any"
    OBJECT = "object"
    CATEGORY = "category"
    NAME = "name"
    LOCATION = "location"
    ROOM = "room"
    GESTURE = "gesture"
    QUESTION = "question"
    WHATTOSAY = "whattosay"

    def admits(self, given: ArgumentKind) -> bool:
        """Return whether an argument of kind ``given`` is allowed where this kind is declared.

        A written-out text may be an entity of any class, and where texts are allowed, tokens are
        too.
        """
        if ArgumentKind.ANY in (self, given) or self is given:
            return True
        is_text = ArgumentKind.TEXT in (self, given)
        return is_text and {self, given} - {ArgumentKind.TEXT} <= ENTITY_KINDS


ENTITY_KINDS = frozenset(map(ArgumentKind, ENTITY_CLASSES))
_OF_TYPE = {
    Variable: ArgumentKind.VARIABLE,
    Lambda: ArgumentKind.LAMBDA,
    Application: ArgumentKind.FORM,
    Unknown: ArgumentKind.UNKNOWN,
}


@dataclass(frozen=True, slots=True, order=True)
class Signature:
    """The kinds of the arguments of a predicate, in order. An overloaded predicate has several."""

    arguments: tuple[ArgumentKind, ...]

    def __str__(self) -> str:
        return f"({', '.join(self.arguments)})"

    def mismatches(self, given: Signature) -> tuple[int, ...]:
        """Return the places (from 0) where ``given``, of the same length, is not allowed."""
        pairs = zip(self.arguments, given.arguments, strict=True)
        return tuple(place for place, (mine, its) in enumerate(pairs) if not mine.admits(its))


def argument_kind(form: Form) -> ArgumentKind:
    """Return the kind of a form as an argument."""
    if isinstance(form, Constant):
        if isinstance(form.value, int):
            return ArgumentKind.NUMBER
        is_class = form.token_class in ENTITY_CLASSES
        return ArgumentKind(form.token_class) if is_class else ArgumentKind.TEXT
    if isinstance(form, Wildcard) and form.entity_class:
        return ArgumentKind(form.entity_class)
    return _OF_TYPE.get(type(form), ArgumentKind.ANY)


def signature_of(application: Application) -> Signature:
    """Return the signature that an application uses."""
    return Signature(tuple(map(argument_kind, application.arguments)))
