"""Descriptions of things and people as data: what has to hold of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from annotations.language.forms import (
    CONJUNCTION,
    PLACING,
    Application,
    Constant,
    EntityClasses,
    Form,
    Lambda,
    Reference,
    Variable,
)
from annotations.language.plans.plan import Condition, Described, Number, OpenValue, Value
from annotations.language.world import NAMING, SUPERLATIVES, Predicate, gloss

ValueOf = Callable[[Constant, str, int], Value]
AT = PLACING  # the predicate that says where something is


@dataclass
class Describer:
    """Makes descriptions; numbers what they describe, so that the same variable is the same thing.

    Somebody who is called by the same name again is the same person.

    ``value_of`` turns a constant at a place of a predicate into a value, ``refer`` the word of a reference.
    """

    predicates: Mapping[str, Predicate]
    value_of: ValueOf
    refer: Callable[[str], Value]
    classes: EntityClasses
    _made: int = field(default=0, init=False)
    _called: dict[str, str] = field(default_factory=dict, init=False)  # name → id

    def _id_of(self, variable: int, conjuncts: Sequence[Form]) -> str:
        """Return the id of what a variable stands for: that of somebody of the same name, or a new one."""
        names = (
            each.arguments[1]
            for each in conjuncts
            if isinstance(each, Application)
            and each.predicate == NAMING
            and each.arguments[:1] == (Variable(variable),)
            and len(each.arguments) == 2
        )
        name = next((each for each in names if isinstance(each, Constant)), None)
        known = None if name is None or name.token_class else str(name.value).casefold()
        if known in self._called:
            return self._called[known]
        self._made += 1
        made = f"x{self._made}"
        if known is not None:
            self._called[known] = made
        return made

    def of_lambda(self, form: Lambda) -> Described:
        """Return the description of what a λ stands for."""
        return self.of_variable(form.variable, tuple(open_lambdas(form)), {})

    def of_variable(
        self,
        variable: int,
        conjuncts: Sequence[Form],
        ids: Mapping[int, str],
        is_inner: bool = False,
    ) -> Described:
        """Return the description of a variable by the conjuncts about it.

        ``ids`` are those of the variables that already have one; they are not described again.
        """
        ids = {variable: self._id_of(variable, conjuncts), **ids}
        applications = [each for each in conjuncts if isinstance(each, Application)]
        about = [each for each in applications if each.arguments[:1] == (Variable(variable),)]
        text = self._text(variable, conjuncts)
        placeless = [each for each in conjuncts if not _says_place(each)]
        short = self._text(variable, placeless) if len(placeless) < len(conjuncts) else ""
        # ``(name $2 $1)`` for ``$1``: the description of something else that names it.
        naming = (each for each in applications if Variable(variable) in each.arguments[1:])
        owner = None if about or is_inner else next(naming, None)
        first = owner.arguments[0] if owner is not None else None
        if owner is not None and isinstance(first, Variable):
            others = [each for each in conjuncts if each is not owner]
            described = self.of_variable(first.index, others, ids, True)
            return Described(ids[variable], text, (), str(owner.predicate), described, short)
        conditions = tuple(
            Condition(
                str(each.predicate),
                tuple(
                    self._value(argument, str(each.predicate), place, conjuncts, ids)
                    for place, argument in enumerate(each.arguments[1:], start=1)
                ),
            )
            for each in about
        )
        return Described(ids[variable], text, conditions, short_text=short)

    def _text(self, variable: int, conjuncts: Sequence[Form]) -> str:
        whole = Lambda(variable, "e", tuple(conjuncts))
        return gloss(whole, self.predicates, self.classes) if conjuncts else ""

    def _value(
        self,
        form: Form,
        predicate: str,
        place: int,
        conjuncts: Sequence[Form],
        ids: Mapping[int, str],
    ) -> Value:
        if isinstance(form, Constant):
            return (
                Number(form.value)
                if isinstance(form.value, int)
                else self.value_of(form, predicate, place)
            )
        if isinstance(form, Lambda):
            return self.of_lambda(form)
        if isinstance(form, Reference):
            return self.refer(form.word)
        if isinstance(form, Variable) and form.index in ids:
            return Described(ids[form.index], "", ())
        if isinstance(form, Variable):
            return self.of_variable(form.index, conjuncts, ids, True)
        return OpenValue("")


def superlative_without_set(described: Described) -> str:
    """Return the superlative of a description that does not say among what; empty if there is none."""
    superlatives = [each for each in described.conditions if each.predicate.endswith(SUPERLATIVES)]
    others = [each for each in described.conditions if each not in superlatives]
    has_set = others or any(not isinstance(v, Number) for each in superlatives for v in each.values)
    return "" if has_set or not superlatives else superlatives[0].predicate


def _says_place(form: Form) -> bool:
    return isinstance(form, Application) and form.predicate == AT


def is_description(form: Form, predicates: Mapping[str, Predicate]) -> bool:
    """Return whether a form describes a variable, rather than says what to do with it."""
    if not isinstance(form, Application) or not isinstance(
        next(iter(form.arguments), None), Variable
    ):
        return False
    declared = predicates.get(str(form.predicate))
    return declared is None or not declared.is_action


def open_lambdas(form: Lambda) -> Iterator[Form]:
    """Yield the bodies below a chain of λs, with explicit conjunctions split."""
    for body in form.bodies:
        if isinstance(body, Lambda):
            yield from open_lambdas(body)
        elif isinstance(body, Application) and body.predicate == CONJUNCTION:
            yield from open_lambdas(Lambda(form.variable, form.type, body.arguments))
        else:
            yield body
