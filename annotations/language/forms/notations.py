"""Print logical forms in the corpus, template and reading notations of ``logic``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeGuard

from annotations.language.forms.printing import print_wildcard
from annotations.language.forms.symbols import Wildcard
from annotations.language.forms.terms import (
    CLASS_TOKEN,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Unknown,
    Variable,
    children,
)

_FIRST_LETTERS = "xyz"


def tokens(form: Form) -> tuple[str, ...]:
    """Return the space-separated tokens of the corpus notation (a bare wildcard is one token)."""
    return tuple(_corpus_tokens(form))


def to_corpus(form: Form) -> str:
    """Return ``( find ( lambda $1 e ( is_a $1 " <object> " ) ) )``."""
    return " ".join(_corpus_tokens(form))


def to_template(form: Form) -> str:
    """Return ``(find (λ$1:e (is_a $1 {kobject})))``."""
    if isinstance(form, Lambda):
        return f"({' '.join((f'λ${form.variable}:{form.type}', *map(to_template, form.bodies)))})"
    if isinstance(form, Application):
        return f"({' '.join((str(form.predicate), *map(to_template, form.arguments)))})"
    return f'"{form.value}"' if _is_text(form) else _leaf(form)


def to_reading(form: Form) -> str:
    """Return ``find(λx. is_a(x, ⟨object⟩))``."""
    if isinstance(form, Lambda):
        type_ = "" if form.type == "e" else f":{form.type}"
        # A λ reaches to the end, so one that is not the last body gets parentheses.
        texts = [
            f"({to_reading(body)})" if isinstance(body, Lambda) else to_reading(body)
            for body in form.bodies[:-1]
        ]
        texts += map(to_reading, form.bodies[-1:])
        return f"λ{letter(form.variable)}{type_}. {' ∧ '.join(texts)}"
    if isinstance(form, Application):
        return f"{form.predicate}({', '.join(map(to_reading, form.arguments))})"
    if isinstance(form, Variable):
        return letter(form.index)
    if isinstance(form, Constant) and (match := CLASS_TOKEN.fullmatch(str(form.value))):
        return f"⟨{match[1]}⟩"
    return f'"{form.value}"' if _is_text(form) else _leaf(form)


def letter(index: int) -> str:
    """Return the name of a variable in the reading notation: x, y, z, x4, x5, …; x0 for index 0."""
    return _FIRST_LETTERS[index - 1] if 1 <= index <= len(_FIRST_LETTERS) else f"x{index}"


def _corpus_tokens(form: Form) -> Iterator[str]:
    if isinstance(form, Lambda | Application):
        yield "("
        if isinstance(form, Lambda):
            yield from ("lambda", f"${form.variable}", form.type)
        else:
            yield str(form.predicate)
        for child in children(form):
            yield from _corpus_tokens(child)
        yield ")"
    elif _is_text(form):
        yield from ('"', *str(form.value).split(), '"')
    else:
        yield _leaf(form)


def _is_text(form: Form) -> TypeGuard[Constant]:
    return isinstance(form, Constant) and isinstance(form.value, str)


def _leaf(form: Form) -> str:
    """Print a leaf other than a text or a variable, the same in every notation."""
    if isinstance(form, Variable):
        return f"${form.index}"
    if isinstance(form, Constant):
        return str(form.value)
    if isinstance(form, Reference):
        return form.word
    if isinstance(form, Wildcard):
        return print_wildcard(form)
    return "UNKNOWN" if isinstance(form, Unknown) else str(form)
