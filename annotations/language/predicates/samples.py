"""A short form for each way to use a predicate, to show what its English sounds like."""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.forms import UNKNOWN, Application, Constant, Form, Lambda, Variable
from annotations.language.predicates.predicates import Predicate
from annotations.language.predicates.signatures import ENTITY_KINDS, ArgumentKind


def sample_forms(predicate: Predicate) -> Iterator[Form]:
    """Yield a form with class tokens for each signature; a description stands in ``find``."""
    for signature in predicate.signatures:
        kinds = signature.arguments
        arguments = tuple(
            _argument(ArgumentKind.ANY if kind in kinds[:place] and kind == "variable" else kind)
            for place, kind in enumerate(kinds)
        )
        form = Application(predicate.name, arguments)
        takes_variable = ArgumentKind.VARIABLE in signature.arguments
        if predicate.is_action and not takes_variable:
            yield form
        else:
            yield Application("find", (Lambda(1, "e", (form,)),))


def _argument(kind: ArgumentKind) -> Form:
    if kind in ENTITY_KINDS:
        return Constant(f"<{kind}>")
    thing = Constant("<object>")
    others: dict[ArgumentKind, Form] = {
        ArgumentKind.VARIABLE: Variable(1),
        ArgumentKind.LAMBDA: Lambda(2, "e", (Application("is_a", (Variable(2), thing)),)),
        ArgumentKind.FORM: Application("go", (Constant("<room>"),)),
        ArgumentKind.NUMBER: Constant(2),
        ArgumentKind.TEXT: Constant("something"),
        ArgumentKind.UNKNOWN: UNKNOWN,
    }
    return others.get(kind, thing)
