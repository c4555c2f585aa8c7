"""The terms of a logical form, as frozen values.

Equality is literal and hashes agree with it; for equality up to the names of variables see
``canonical``. Import the terms from ``forms``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from annotations.language.forms.entity_classes import DEFAULT_CLASSES
from annotations.language.forms.symbols import Nonterminal, Wildcard

# Words of the notation: arguments that hold together, as the bodies of one λ do, and actions in order.
CONJUNCTION = "and"
SEQUENCE = "sequence"
CLASS_TOKEN = re.compile(r"<([^\W\d]\w*)>")
# Files of others write <object0> so. Any word may end in a number, and no world is at hand here.
_BARE_TOKEN = re.compile(rf"({'|'.join(DEFAULT_CLASSES.tokens)})[0-9]+")


@dataclass(frozen=True, slots=True)
class Variable:
    """``$index``, bound by a λ around it."""

    index: int


@dataclass(frozen=True, slots=True)
class Constant:
    """A quoted text (the name of an entity, a class token such as ``<object>``) or an integer.

    Runs of whitespace become one space and quotation marks become apostrophes, so that every
    constant can be printed in every notation.
    """

    value: str | int

    def __post_init__(self) -> None:
        if isinstance(self.value, str):
            object.__setattr__(self, "value", " ".join(self.value.replace('"', "'").split()))

    @property
    def token_class(self) -> str:
        """``object`` for ``<object>``, ``<object0>`` and ``object0``; empty for anything else."""
        if not isinstance(self.value, str):
            return ""
        match = CLASS_TOKEN.fullmatch(self.value) or _BARE_TOKEN.fullmatch(self.value)
        return match[1].rstrip("0123456789") if match else ""


@dataclass(frozen=True, slots=True)
class Unknown:
    """``UNKNOWN``: a command without a form, or an argument that the command leaves open."""


@dataclass(frozen=True, slots=True)
class Reference:
    """``it`` or ``them``: the last thing or the last person that was described before."""

    word: str


@dataclass(frozen=True, slots=True)
class Application:
    """``(predicate argument …)``; in a template a nonterminal may stand as the predicate."""

    predicate: str | Nonterminal
    arguments: tuple[Form, ...] = ()


@dataclass(frozen=True, slots=True)
class Lambda:
    """``(λ$variable:type body …)``: what satisfies every body."""

    variable: int
    type: str
    bodies: tuple[Form, ...]


Form: TypeAlias = (
    "Lambda | Application | Variable | Constant | Reference | Wildcard | Nonterminal | Unknown"
)

UNKNOWN = Unknown()


def children(form: Form) -> tuple[Form, ...]:
    """Return the bodies of a λ or the arguments of an application; nothing for a leaf."""
    if isinstance(form, Lambda):
        return form.bodies
    return form.arguments if isinstance(form, Application) else ()


def with_part(form: Form, path: Sequence[int], part: Form) -> Form:
    """Return the form with another part at ``path``, which leads to it by child numbers. Raises IndexError."""
    if not path:
        return part
    place, rest = path[0], path[1:]
    parts = list(children(form))
    parts[place] = with_part(parts[place], rest, part)
    if isinstance(form, Lambda):
        return Lambda(form.variable, form.type, tuple(parts))
    assert isinstance(form, Application)
    return Application(form.predicate, tuple(parts))


def with_leaves(form: Form, change: Callable[[Form], Form]) -> Form:
    """Return the form with ``change`` of everything in it that has no parts, in order."""
    if isinstance(form, Lambda):
        bodies = tuple(with_leaves(each, change) for each in form.bodies)
        return Lambda(form.variable, form.type, bodies)
    if isinstance(form, Application):
        return Application(
            form.predicate, tuple(with_leaves(each, change) for each in form.arguments)
        )
    return change(form)


def walk(form: Form) -> Iterator[Form]:
    """Yield the form and everything inside it, each before its parts."""
    yield form
    for child in children(form):
        yield from walk(child)


def depth(form: Form) -> int:
    """Return how deep λs and applications nest: 0 for a leaf, 1 for ``(go "kitchen")``."""
    if isinstance(form, Lambda | Application):
        return 1 + max(map(depth, children(form)), default=0)
    return 0


def size(form: Form) -> int:
    """Return how many λs, applications and leaves a form consists of."""
    return sum(1 for _ in walk(form))


def predicates(form: Form) -> tuple[str, ...]:
    """Return the names of the predicates in order of appearance, including repetitions."""
    return tuple(str(node.predicate) for node in walk(form) if isinstance(node, Application))


def head_predicate(form: Form) -> str:
    """Return the outermost predicate (below a λ at the top); ``UNKNOWN`` for a form without any."""
    return next(iter(predicates(form)), "UNKNOWN")


def actions_of(form: Form) -> tuple[Form, ...]:
    """Return the actions of a sequence in order; the form itself where it is none."""
    if isinstance(form, Application) and form.predicate == SEQUENCE:
        return form.arguments
    return (form,)


def free_variables(form: Form) -> frozenset[int]:
    """Return the variables that no λ of the form binds; none for a form from ``read_form``."""
    if isinstance(form, Variable):
        return frozenset((form.index,))
    inside = frozenset[int]().union(*map(free_variables, children(form)))
    return inside - {form.variable} if isinstance(form, Lambda) else inside
