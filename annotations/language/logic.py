"""Logical forms: frozen values (``terms``), read from and printed in three notations.

template  ``(find (λ$1:e (is_a $1 {kobject})))``, what people annotate
corpus    ``( find ( lambda $1 e ( is_a $1 " <object> " ) ) )``, what parsers learn
reading   ``find(λx. is_a(x, ⟨object⟩))``, what pages show

Several bodies under one λ mean their conjunction (``∧`` in the reading notation) and stay distinct
from an explicit ``(and a b)``, as in the published corpus.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import Any

from lark import Lark, Token, Transformer, UnexpectedInput, v_args

from annotations.language.errors import LanguageError, Position
from annotations.language.form_errors import explained, place_of
from annotations.language.form_printing import letter, to_corpus, to_reading, to_template, tokens
from annotations.language.symbols import Nonterminal, Wildcard
from annotations.language.terms import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Unknown,
    Variable,
    children,
    depth,
    free_variables,
    head_predicate,
    predicates,
    walk,
)
from annotations.language.wildcards import read_wildcard

__all__ = [
    "DEEPEST",
    "UNKNOWN",
    "Application",
    "Constant",
    "Form",
    "Lambda",
    "Unknown",
    "Variable",
    "children",
    "depth",
    "free_variables",
    "head_predicate",
    "letter",
    "predicates",
    "read_form",
    "to_corpus",
    "to_reading",
    "to_template",
    "tokens",
    "walk",
]

DEEPEST = 64
_SHIELDED = r'"[^"]*"|\{[^{}]*\}'  # parentheses in here do not nest anything
_NESTING = re.compile(
    rf"{_SHIELDED}|(?P<call>(?<=[\w-])\()|(?P<open>\()|(?P<close>\))|(?P<reach>λ|lambda(?![\w-]))"
)


def read_form(text: str, position: Position | None = None) -> Form:
    """Reads a logical form in whichever of the three notations it is written.

    Args:
        text: one form; λ or ``lambda``, spacing, ``:`` and ``.`` after a variable are free.
        position: where the first character of ``text`` stands in its source.

    Returns:
        A λ, an application or ``UNKNOWN``, with every variable bound.

    Raises:
        LanguageError: with the position, for text that is no form, for a variable that no λ binds
            and for more than 64 levels.
    """
    try:
        return _read(text)
    except LanguageError as error:
        raise LanguageError(error.message, _moved(error.position, position), error.hint) from None


@lru_cache(maxsize=1 << 16)
def _read(text: str) -> Form:
    start = "expression" if text.lstrip().startswith("(") else "reading"
    _refuse_deep(text, start)
    try:
        form: Form = _LARK.parse(text, start=start)  # type: ignore[assignment]
    except UnexpectedInput as error:
        raise explained(error, text) from None
    _refuse_unbound(form, text, start)
    if not isinstance(form, Lambda | Application | Unknown):
        raise LanguageError(
            "this is an argument, not a logical form",
            place_of(text, len(text) - len(text.lstrip())),
            'write a predicate around it, as in (go "kitchen"), or UNKNOWN',
        )
    return form


@v_args(inline=True)
class _Builder(Transformer[Token, Form]):
    """Makes the value of each grammar rule while lark parses, so that no tree is built."""

    def abstraction(self, variable: Token, *rest: Any) -> Lambda:
        type_, bodies = ("e", rest) if isinstance(rest[0], Lambda) else (rest[0], rest[1:])
        return Lambda(_index(variable), str(type_ or "e"), tuple(bodies))

    def application(self, predicate: str | Nonterminal, *arguments: Form) -> Application:
        return Application(predicate, arguments)

    def head(self, name: Token) -> str | Nonterminal:
        return Nonterminal(name[1:]) if name.type == "NONTERMINAL" else str(name)

    def variable(self, name: Token) -> Variable:
        return Variable(_index(name))

    def class_token(self, token: Token) -> Constant:
        return Constant(f"<{token[1:-1].strip()}>")

    def text(self, quoted: Token) -> Constant:
        constant = Constant(quoted[1:-1])
        if not constant.value:
            raise LanguageError(
                "there is nothing between the quotation marks", _start(quoted), 'write "cereal"'
            )
        return constant

    def integer(self, digits: Token) -> Constant:
        return Constant(int(digits))

    def unknown(self, _: Token) -> Unknown:
        return UNKNOWN

    def slot(self, braces: Token) -> Wildcard:
        return read_wildcard(str(braces), _start(braces))

    def nonterminal(self, name: Token) -> Nonterminal:
        return Nonterminal(name[1:])


_LARK = Lark(
    Path(__file__).with_name("logic.lark").read_text(encoding="utf-8"),
    parser="lalr",
    start=["expression", "reading"],
    transformer=_Builder(),
)


def _index(variable: Token) -> int:
    """``$2`` and ``y`` are 2, ``x4`` is 4."""
    if variable.startswith("$"):
        return int(variable[1:])
    return int(variable[1:]) if variable[1:] else "xyz".index(variable) + 1


def _refuse_deep(text: str, start: str) -> None:
    """Looks at brackets alone, before anything recursive could meet a text that is too deep."""
    deepening = ("call", "reach") if start == "reading" else ("call", "open")
    level = 0
    outer: list[int] = []
    for match in _NESTING.finditer(text):
        if match["call"] or match["open"]:
            outer.append(level)
        elif match["close"]:
            level = outer.pop() if outer else 0
        level += match.lastgroup in deepening
        if level > DEEPEST:
            raise LanguageError(
                f"the form nests more than {DEEPEST} deep",
                place_of(text, match.start()),
                "split it, or close a parenthesis earlier",
            )


def _refuse_unbound(form: Form, text: str, start: str) -> None:
    """Terms carry no positions, so the n-th variable of the form is looked up as the n-th token."""
    number = next((n for n, is_bound in enumerate(_occurrences(form)) if not is_bound), None)
    if number is None:
        return
    lexed = _LARK.parse_interactive(text, start=start).iter_parse()
    names: Iterable[Token] = (token for token in lexed if token.type in ("VARIABLE", "LETTER"))
    token = next(islice(names, number, None))
    raise LanguageError(
        f"the variable {token} is bound by no λ around it",
        _start(token),
        f"write (λ${_index(token)}:e …) around it, or use the variable of a λ that is there",
    )


def _occurrences(form: Form, bound: frozenset[int] = frozenset()) -> Iterator[bool]:
    """For each variable as it is written, those behind a λ included: is it bound?"""
    if isinstance(form, Lambda):
        yield True
        bound |= {form.variable}
    elif isinstance(form, Variable):
        yield form.index in bound
    for child in children(form):
        yield from _occurrences(child, bound)


def _start(token: Token) -> Position:
    return Position("", token.line or 1, token.column or 1)


def _moved(inner: Position, outer: Position | None) -> Position:
    """A position inside the text, seen from the source in which the text begins at ``outer``."""
    if outer is None:
        return inner
    column = inner.column + (outer.column - 1 if inner.line == 1 else 0)
    return Position(outer.source, outer.line + inner.line - 1, column)
