"""Read the λ-calculus of other corpora (GeoQuery, ATIS, and what follows Zettlemoyer and Collins) as forms.

    (lambda $0 e (and (flight $0) (from $0 boston:ci)))      (argmax $0 (state:t $0) (size:i $0))
    (lambda $0:e (and:<t*,t> (state:<s,t> $0) (loc:<lo,<lo,t>> $0 texas:s)))

| there | here |
| --- | --- |
| ``boston:ci``, ``1800:ti``, ``ci0`` | a text, with its type: ``" boston:ci "`` |
| ``5`` | an integer |
| ``state:t``, ``state:<s,t>`` as a predicate | ``state``; the type is left out |
| ``(argmax $0 A B)``, ``(count $0 A)``, ``(the $0 A)`` and other binders | ``(argmax (λ$0:e A) (λ$0:e B))``, … |
| ``=``, ``!=`` | ``equals``, ``differs`` |
| ``<``, ``>``, ``<=``, ``>=`` | ``less_than``, ``greater_than``, ``at_most``, ``at_least`` |
| ``($0 $1)``, ``((lambda …) A)`` | ``(apply $0 $1)``, … |
| ``<e,t>`` after a λ; a λ without a type | ``e_t``; ``e`` |
| ``?x``, ``$flight`` | variables, numbered |
| ``'visual basic'`` | a text |
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from annotations.language.forms.canonical import canonical_text
from annotations.language.forms.logic import read_form
from annotations.language.forms.terms import Application, Constant, Form, Lambda, Variable
from annotations.language.texts import (
    MAX_FORM,
    MAX_INDEXED_BYTES,
    MAX_NESTING,
    MAX_PREDICATE,
    LanguageError,
    Offsets,
    Position,
)

# A constant in single quotation marks ends before a blank or parenthesis: o'brien is one without.
_TOKEN = re.compile(r"""[()]|"[^"]*"|'[^'()"]*'(?=[\s()]|\Z)|[^\s()"]+|\"""")
_VARIABLE = re.compile(r"(?P<name>[$?]\w{1,40})(?::(?P<type>\S+))?")
_INTEGER = re.compile(r"-?\d{1,40}")
_NAME = re.compile(r"[^\W\d][\w-]*")
_TYPE = re.compile(r"[^\W\d]\w*")
_LAMBDAS = frozenset({"lambda", "_lambda", "λ"})
_OPERATORS = {
    "=": "equals",
    "<": "less_than",
    ">": "greater_than",
    "<=": "at_most",
    ">=": "at_least",
    "!=": "differs",
}
_APPLY = "apply"
_USUAL_TYPE = "e"


def read_foreign_form(text: str, position: Position | None = None) -> Form:
    """Read one form in the notation of another corpus.

    Returns:
        A form whose canonical text reads back as the same form.

    Raises:
        LanguageError: with the position; the message is the reason alone, the same for every text that
            has it, so that reasons can be counted.
    """
    place = position or Position()
    try:
        return _ForeignReader(text).form()
    except LanguageError as error:
        raise LanguageError(error.message, error.position.inside(place), error.hint) from None


@dataclass(frozen=True, slots=True)
class _List:
    """What stands between parentheses, not yet a form."""

    start: int
    items: Sequence[_List | re.Match[str]]


class _ForeignReader:
    def __init__(self, text: str) -> None:
        self._text = text
        self._offsets = Offsets(text)
        self._variables = 0  # so far; each gets a number of its own

    def form(self) -> Form:
        if len(self._text) > MAX_FORM:
            raise self._fail("the form is too long", 0)
        form = self._read(self._tree(), {})
        if not isinstance(form, Lambda | Application):
            raise self._fail("this is a constant, not a form", 0)
        written = canonical_text(form)
        if len(written.encode()) > MAX_INDEXED_BYTES:
            raise self._fail("the form is too long", 0)
        if canonical_text(read_form(written)) != written:
            raise self._fail("this form cannot be written here", 0)
        return form

    def _tree(self) -> _List | re.Match[str]:
        """Return the one expression that the text holds."""
        top: list[_List | re.Match[str]] = []
        outer: list[tuple[int, list[_List | re.Match[str]]]] = []
        items = top
        for token in _TOKEN.finditer(self._text):
            if token[0] == "(":
                if len(outer) >= MAX_NESTING:
                    raise self._fail(f"the form nests more than {MAX_NESTING} deep", token.start())
                outer.append((token.start(), items))
                items = []
            elif token[0] == ")":
                if not outer:
                    raise self._fail("this ) closes nothing", token.start())
                start, around = outer.pop()
                around.append(_List(start, items))
                items = around
            else:
                items.append(token)
        if outer:
            raise self._fail("this ( is never closed", outer[-1][0])
        if not top:
            raise self._fail("there is no form", 0)
        if len(top) > 1 and not isinstance(top[0], _List) and top[0][0] in _LAMBDAS:
            return _List(top[0].start(), top)  # a λ without parentheses around it
        if len(top) > 1:
            second = top[1]
            start = second.start if isinstance(second, _List) else second.start()
            raise self._fail("there is more than one form", start)
        return top[0]

    def _read(self, node: _List | re.Match[str], bound: dict[str, int]) -> Form:
        if not isinstance(node, _List):
            return self._leaf(node, bound)
        if not node.items:
            raise self._fail("there is nothing between the parentheses", node.start)
        head, *rest = node.items
        if isinstance(head, _List):
            return self._application(_APPLY, node.items, bound)
        word, _, _ = head[0].partition(":")
        if word in _LAMBDAS:
            return self._abstraction(node, rest, bound)
        if word == "call":
            raise self._fail("(call …) is a program, not λ-calculus", node.start)
        if _VARIABLE.fullmatch(head[0]):
            return self._application(_APPLY, node.items, bound)
        name = _OPERATORS.get(word) or _OPERATORS.get(word.removeprefix("_")) or word
        if not _NAME.fullmatch(name) or len(name) > MAX_PREDICATE:
            raise self._fail(
                "the name of a predicate has other characters than a name", head.start()
            )
        if rest and not isinstance(rest[0], _List) and len(rest) > 1:
            binder = _VARIABLE.fullmatch(rest[0][0])
            is_new = binder and binder["name"] not in bound
            if binder and is_new and any(_mentions(part, binder["name"]) for part in rest[1:]):
                bodies = (
                    self._lambda(binder["name"], _USUAL_TYPE, each, bound) for each in rest[1:]
                )
                return Application(name, tuple(bodies))
        return self._application(name, rest, bound)

    def _application(
        self, name: str, items: Sequence[_List | re.Match[str]], bound: dict[str, int]
    ) -> Form:
        return Application(name, tuple(self._read(each, bound) for each in items))

    def _abstraction(
        self, node: _List, rest: list[_List | re.Match[str]], bound: dict[str, int]
    ) -> Form:
        variable = (
            None if not rest or isinstance(rest[0], _List) else _VARIABLE.fullmatch(rest[0][0])
        )
        if variable is None:
            raise self._fail("a λ has no variable", node.start)
        type_, bodies = variable["type"], rest[1:]
        if type_ is None and len(bodies) > 1 and not isinstance(bodies[0], _List):
            type_, bodies = bodies[0][0], bodies[1:]
        elif type_ is None and len(bodies) == 1 and isinstance(bodies[0], _List):
            type_ = _USUAL_TYPE
        elif type_ is None:
            raise self._fail("the variable of a λ has no type", node.start)
        if len(bodies) != 1:
            raise self._fail("a λ has no body, or several", node.start)
        plain = type_.replace("<", "").replace(">", "").replace(",", "_").replace("*", "s")
        if not _TYPE.fullmatch(plain):
            raise self._fail("the variable of a λ has no type", node.start)
        return self._lambda(variable["name"], plain, bodies[0], bound)

    def _lambda(
        self, name: str, type_: str, body: _List | re.Match[str], bound: dict[str, int]
    ) -> Form:
        self._variables += 1
        index = self._variables
        return Lambda(index, type_, (self._read(body, {**bound, name: index}),))

    def _leaf(self, token: re.Match[str], bound: dict[str, int]) -> Form:
        text = token[0]
        if variable := _VARIABLE.fullmatch(text):
            if variable["name"] not in bound:
                raise self._fail("nothing binds a variable", token.start())
            return Variable(bound[variable["name"]])
        if text.startswith("$"):
            raise self._fail(
                "the name of a variable has other characters than a name", token.start()
            )
        if _INTEGER.fullmatch(text):
            return Constant(int(text))
        is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "'\""
        value = text[1:-1] if is_quoted else text
        if not value.strip() or '"' in value:
            raise self._fail("a constant is empty, or its quotation marks are", token.start())
        return Constant(value)

    def _fail(self, reason: str, at: int) -> LanguageError:
        return LanguageError(reason, self._offsets.position(at))


def _mentions(node: _List | re.Match[str], name: str) -> bool:
    """Return whether a part of a form has the variable. Where none has it, nothing is bound: ``(from $0 boston)``."""
    if not isinstance(node, _List):
        return node[0].partition(":")[0] == name
    return any(_mentions(each, name) for each in node.items)
