"""What a typed form may consist of, and the least that completes a part of one.

Lengths are bytes of the corpus notation with a space after each token. A form that keeps to ``longest``
therefore fits wherever forms are stored.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Self

from annotations.language.forms import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Variable,
    children,
    depth,
    walk,
)
from annotations.language.texts import MAX_INDEXED_BYTES, MAX_NESTING
from annotations.language.world import (
    ArgumentKind,
    Predicate,
    admits,
    argument_kind,
    infer_signatures,
    is_entity_kind,
)
from parser_service.parsers.remembering import remembered

NEVER = 10**9  # bytes: more than any form may have
NESTED = (ArgumentKind.LAMBDA, ArgumentKind.FORM)  # also what a λ holds
DEEPER = 1  # levels that a form may nest deeper than all of training
LONGER = 1.5  # times the longest form of training

Kinds = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Rules:
    """Predicates with the kinds of their arguments, constants, and how deep and long forms may be.

    ``references`` are those that forms have: it, them. ``types`` are those of λs, ``lambdas`` the most λs
    around a term, ``deepest`` the most λs and applications around one, ``longest`` the bytes of a form, and
    ``may_refuse`` tells whether UNKNOWN may be a whole form.
    """

    signatures: Mapping[str, tuple[Kinds, ...]]
    constants: tuple[Constant, ...]
    types: tuple[str, ...]
    lambdas: int
    deepest: int
    longest: int
    may_refuse: bool
    references: tuple[Reference, ...] = ()

    @classmethod
    def of(
        cls,
        forms: Sequence[Form],
        predicates: Mapping[str, Predicate] | None,
        longest: int = MAX_INDEXED_BYTES,
    ) -> Self:
        """Return the rules that ``forms`` keep to.

        Args:
            forms: those of the training pairs.
            predicates: the declared ones, whose class tokens are constants, too; None, or none, to
                infer them from ``forms``.
            longest: the most bytes that a form may have.
        """
        nodes = [node for form in forms for node in walk(form)]
        known = predicates or infer_signatures(forms)
        signatures = {name: tuple(s.arguments for s in known[name].signatures) for name in known}
        constants = {node for node in nodes if isinstance(node, Constant)}
        if predicates:
            kinds = {kind for each in signatures.values() for kinds in each for kind in kinds}
            constants |= {Constant(f"<{kind}>") for kind in filter(is_entity_kind, kinds)}
        return cls(
            signatures={name: each for name, each in signatures.items() if each},
            constants=tuple(sorted(constants, key=lambda each: (str(each.value), repr(each)))),
            types=tuple(sorted({node.type for node in nodes if isinstance(node, Lambda)} | {"e"})),
            lambdas=max((_lambdas(form) for form in forms), default=1) or 1,
            deepest=min(MAX_NESTING, DEEPER + max(map(depth, forms), default=3)),
            longest=min(longest, round(LONGER * max(map(length, forms), default=100))),
            may_refuse=UNKNOWN in forms,
            references=tuple(
                sorted({node for node in nodes if isinstance(node, Reference)}, key=str)
            ),
        )

    def to_json(self) -> dict[str, Any]:
        return {
            **asdict(self),
            "constants": [each.value for each in self.constants],
            "references": [each.word for each in self.references],
        }

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """Return what ``to_json`` wrote."""
        signatures = {name: tuple(map(tuple, each)) for name, each in values["signatures"].items()}
        constants = tuple(map(Constant, values["constants"]))
        return cls(
            **{
                **values,
                "signatures": signatures,
                "constants": constants,
                "types": tuple(values["types"]),
                "references": tuple(map(Reference, values.get("references", ()))),
            }
        )

    def leaves(self, bound: int) -> Iterator[Form]:
        """Yield the terms without parts that may stand inside ``bound`` λs."""
        yield from self.constants
        yield from self.references
        yield UNKNOWN
        for index in range(1, bound + 1):
            yield Variable(index)


def length(form: Form) -> int:
    """Return the bytes of a form and a space."""
    return own_length(form) + sum(map(length, children(form)))


def own_length(form: Form) -> int:
    """Return the bytes of a term without its parts."""
    if isinstance(form, Application):
        return _bytes(f"( {form.predicate} ) ")
    if isinstance(form, Lambda):
        return _bytes(f"( lambda ${form.variable} {form.type} ) ")
    if isinstance(form, Variable):
        return _bytes(f"${form.index} ")
    if isinstance(form, Constant):
        return _bytes(f"{form.value} " if isinstance(form.value, int) else f'" {form.value} " ')
    return _bytes(f"{form.word} " if isinstance(form, Reference) else "UNKNOWN ")


def _bytes(text: str) -> int:
    return len(text.encode())


def _lambdas(form: Form) -> int:
    inside = max(map(_lambdas, children(form)), default=0)
    return inside + isinstance(form, Lambda)


class Costs:
    """The least bytes of terms by ``rules``; ``NEVER`` where there is no such term.

    ``level`` is the number of λs and applications around a term, ``bound`` that of λs.
    """

    def __init__(self, rules: Rules):
        self.rules = rules

    @remembered()
    def leaf(self, kind: str, bound: int) -> int:
        """Of a leaf that is allowed where ``kind`` is declared."""
        allowed = (x for x in self.rules.leaves(bound) if admits(kind, argument_kind(x)))
        return min(map(own_length, allowed), default=NEVER)

    @remembered()
    def nested(self, kind: str, level: int, bound: int) -> int:
        """Of a λ or an application that is allowed where ``kind`` is declared."""
        is_allowed = any(admits(kind, each) for each in NESTED)
        if not is_allowed or level >= self.rules.deepest:
            return NEVER
        of_lambda = of_form = NEVER
        if admits(kind, ArgumentKind.LAMBDA) and bound < self.rules.lambdas:
            own = min(own_length(Lambda(bound + 1, each, ())) for each in self.rules.types)
            of_lambda = own + self.body(level + 1, bound + 1)
        if admits(kind, ArgumentKind.FORM):
            of_form = min(
                (
                    own_length(Application(name)) + self.fill(kinds, 0, False, level + 1, bound)
                    for name, overloads in self.rules.signatures.items()
                    for kinds in overloads
                ),
                default=NEVER,
            )
        return min(NEVER, of_lambda, of_form)

    def body(self, level: int, bound: int) -> int:
        """Of what may stand in a λ: another λ or an application."""
        return self.nested(ArgumentKind.ANY, level, bound)

    @remembered()
    def fill(self, kinds: Kinds, filled: int, needs_nested: bool, level: int, bound: int) -> int:
        """Of the arguments from number ``filled`` on, with a λ or an application among them where
        ``needs_nested``."""
        costs = [
            min(self.leaf(kind, bound), self.nested(kind, level, bound)) for kind in kinds[filled:]
        ]
        total = sum(costs)
        if needs_nested:
            total += min(
                (
                    self.nested(kind, level, bound) - cost
                    for kind, cost in zip(kinds[filled:], costs, strict=True)
                ),
                default=NEVER,
            )
        return min(NEVER, total)
