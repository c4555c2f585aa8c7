"""Give equal forms the same text: rename variables and ignore the order of conjuncts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from annotations.language.forms.notations import to_corpus
from annotations.language.forms.terms import (
    CONJUNCTION,
    Application,
    Form,
    Lambda,
    Variable,
    free_variables,
)


def canonicalize(form: Form) -> Form:
    """Rename variables by binding depth: the outermost λ is ``$1``, the next inside it ``$2``.

    λs next to each other reuse a number, as in the published corpus. Variables that no λ of the
    form binds keep their names, and the bound ones are numbered above them.
    """
    return _rename(form, {}, 1 + max(free_variables(form), default=0))


def canonical_text(form: Form) -> str:
    """Return the canonical form in corpus notation, the same text for exactly the α-equivalent forms.

    Exact match compares this text. It is the corpus line itself if that line names its variables by
    depth.
    """
    return to_corpus(canonicalize(form))


def equivalent(first: Form, second: Form) -> bool:
    """Return whether two forms are α-equivalent up to the order of conjuncts.

    Conjuncts are the bodies of one λ and the arguments of an explicit ``and``; the two ways to
    write a conjunction stay distinct.
    """
    return _order(canonicalize(first)) == _order(canonicalize(second))


def flatten_conjunctions(form: Form) -> Form:
    """Write every explicit ``and`` below a λ as several bodies of it."""
    if isinstance(form, Application):
        return replace(form, arguments=tuple(map(flatten_conjunctions, form.arguments)))
    if not isinstance(form, Lambda):
        return form
    return replace(form, bodies=tuple(each for body in form.bodies for each in _conjuncts(body)))


def _conjuncts(body: Form) -> Iterator[Form]:
    if isinstance(body, Application) and body.predicate == CONJUNCTION:
        for each in body.arguments:
            yield from _conjuncts(each)
    else:
        yield flatten_conjunctions(body)


def _rename(form: Form, names: Mapping[int, int], next_name: int) -> Form:
    if isinstance(form, Variable):
        return Variable(names.get(form.index, form.index))
    if isinstance(form, Application):
        arguments = tuple(_rename(argument, names, next_name) for argument in form.arguments)
        return replace(form, arguments=arguments)
    if isinstance(form, Lambda):
        inner = {**names, form.variable: next_name}
        bodies = tuple(_rename(body, inner, next_name + 1) for body in form.bodies)
        return Lambda(next_name, form.type, bodies)
    return form


def _order(form: Form) -> Form:
    """Sort conjuncts by their text. Names by depth do not depend on the order, so this is sound."""
    if isinstance(form, Lambda):
        return replace(form, bodies=_sort(form.bodies))
    if isinstance(form, Application):
        if form.predicate == CONJUNCTION:
            return replace(form, arguments=_sort(form.arguments))
        return replace(form, arguments=tuple(map(_order, form.arguments)))
    return form


def _sort(conjuncts: tuple[Form, ...]) -> tuple[Form, ...]:
    return tuple(sorted(map(_order, conjuncts), key=to_corpus))
