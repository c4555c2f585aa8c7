"""One text for one form: renaming of variables, order of conjuncts, and the diff of two forms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from annotations.language.logic import (
    Application,
    Form,
    Lambda,
    Variable,
    free_variables,
    to_corpus,
)


def canonicalize(form: Form) -> Form:
    """Renames variables by binding depth: the outermost λ is ``$1``, the next inside it ``$2``.

    λs beside each other reuse a number, as in the published corpus. Variables that no λ of the form
    binds keep their names, and the bound ones then count from above them.
    """
    return _renamed(form, {}, 1 + max(free_variables(form), default=0))


def canonical_text(form: Form) -> str:
    """The corpus notation of the canonical form: equal exactly for α-equivalent forms.

    Exact match compares this text. It is the corpus line itself wherever that line names its
    variables by depth.
    """
    return to_corpus(canonicalize(form))


def equivalent(first: Form, second: Form) -> bool:
    """α-equivalence that also ignores the order of conjuncts.

    Conjuncts are the bodies of one λ and the arguments of an explicit ``and``; the two ways to
    write a conjunction stay distinct from each other.
    """
    return _ordered(canonicalize(first)) == _ordered(canonicalize(second))


def _renamed(form: Form, names: Mapping[int, int], next_name: int) -> Form:
    if isinstance(form, Variable):
        return Variable(names.get(form.index, form.index))
    if isinstance(form, Application):
        arguments = tuple(_renamed(argument, names, next_name) for argument in form.arguments)
        return replace(form, arguments=arguments)
    if isinstance(form, Lambda):
        inner = {**names, form.variable: next_name}
        bodies = tuple(_renamed(body, inner, next_name + 1) for body in form.bodies)
        return Lambda(next_name, form.type, bodies)
    return form


def _ordered(form: Form) -> Form:
    """Sorts conjuncts by their text; names by depth do not depend on the order, so this is sound."""
    if isinstance(form, Lambda):
        return replace(form, bodies=_sorted(form.bodies))
    if isinstance(form, Application):
        if form.predicate == "and":
            return replace(form, arguments=_sorted(form.arguments))
        return replace(form, arguments=tuple(map(_ordered, form.arguments)))
    return form


def _sorted(conjuncts: tuple[Form, ...]) -> tuple[Form, ...]:
    return tuple(sorted(map(_ordered, conjuncts), key=to_corpus))
