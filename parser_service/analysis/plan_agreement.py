"""Whether two anonymized forms have the same task plan: whether a robot would do the same for both."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from annotations.language.forms import Application, Constant, Form, Lambda
from annotations.language.plans import (
    Lookup,
    Named,
    RecipeBook,
    Trouble,
    Value,
    apply_recipes,
    make_plan,
    plan_key,
)
from annotations.language.world import Ontology, Predicate

MOST_KEPT = 50_000  # plans; the forms of a run come again and again
# The plan of a form that says nothing to do is the same as no other.
_NOTHING_TO_DO = frozenset(map(str, (Trouble.NOT_UNDERSTOOD, Trouble.NO_ACTION)))
_STAND_IN = re.compile(r"⟨([^\W\d]*+)[\d.]*+⟩")


@dataclass(frozen=True)
class PlanAgreement:
    """Says of two forms whether their task plans are the same, by one ontology and one recipe book.

    A class token is taken for an entity of its class: else both plans would only ask for it. The tokens of a class are
    taken for different entities, in the order in which a form has them: two rooms of a command need not be one, and
    whoever takes them for one would find a robot there already.
    """

    ontology: Ontology
    predicates: Mapping[str, Predicate]
    book: RecipeBook
    _keys: dict[Form, Hashable] = field(default_factory=dict, init=False, repr=False, compare=False)

    def __call__(self, first: Form, second: Form) -> bool:
        """Return whether the plans have equal steps (``recipes.same_plan``), and say what to do at all."""
        key = self._key(first)
        return key is not None and key == self._key(second)

    @cached_property
    def _lookup(self) -> Lookup:
        return _LookupOfStandIns(self.ontology, self.predicates)

    def _key(self, form: Form) -> Hashable:
        """Return what forms with the same plan share; None for one that says nothing to do."""
        if form not in self._keys:
            if len(self._keys) >= MOST_KEPT:
                self._keys.clear()
            filled = _with_stand_ins(form, Counter())
            plan = make_plan(filled, self.ontology, self.predicates, lookup=self._lookup)
            task_plan = apply_recipes(plan, self.book)
            is_void = any(each.code in _NOTHING_TO_DO for each in task_plan.problems)
            self._keys[form] = None if is_void else plan_key(task_plan)
        return self._keys[form]


class _LookupOfStandIns(Lookup):
    """Takes what stands in for a class token for an entity of that class."""

    def value(self, text: str, predicate: str, place: int) -> tuple[Value, bool]:
        if match := _STAND_IN.fullmatch(text):
            return Named(match[1], text), False
        return super().value(text, predicate, place)


def _with_stand_ins(form: Form, seen: Counter[str]) -> Form:
    """Return the form with an entity in place of each class token.

    Args:
        form: a form or a part of one.
        seen: class → how many tokens without a number came before; those in ``form`` are added.
    """
    if isinstance(form, Constant) and (token_class := form.token_class):
        token = str(form.value).strip("<>")
        if token != token_class:  # a number says which one is meant
            return Constant(f"⟨{token}⟩")
        seen[token_class] += 1
        return Constant(f"⟨{token_class}.{seen[token_class]}⟩")
    if isinstance(form, Application):
        parts = tuple(_with_stand_ins(each, seen) for each in form.arguments)
        return replace(form, arguments=parts)
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(_with_stand_ins(each, seen) for each in form.bodies))
    return form
