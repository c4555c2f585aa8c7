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
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import islice
from pathlib import Path
from typing import Any

from lark import Lark, Token, Transformer, Tree, UnexpectedCharacters, UnexpectedInput, v_args

from annotations.language.forms.reader import read_wildcard
from annotations.language.forms.symbols import Nonterminal, Wildcard
from annotations.language.forms.terms import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Unknown,
    Variable,
    children,
)
from annotations.language.texts import (
    MAX_FORM,
    MAX_NESTING,
    MAX_NONTERMINAL,
    MAX_PREDICATE,
    LanguageError,
    Offsets,
    Position,
    require_length,
    require_name,
    require_writable,
)

_SHIELDED = r'"[^"]*"|\{[^{}]*\}'  # parentheses in here do not count
_NESTING = re.compile(
    rf"{_SHIELDED}|(?P<call>(?<=[\w-])\()|(?P<open>\()|(?P<close>\))|(?P<reach>λ|lambda(?![\w-]))"
)
_DOUBLE, _SINGLE = "“”„‟«»＂〝〞", "‘’‚‛‹›`´"
_TYPESET = re.compile(
    rf'"[^"]*"|[{_DOUBLE}][^"{_DOUBLE}]*[{_DOUBLE}]|[{_SINGLE}][^"{_DOUBLE}{_SINGLE}()]*[{_SINGLE}]|[（）｛｝＄，：．＿＜＞]'
)
_PLAIN = str.maketrans("（）｛｝＄，：．＿＜＞", "(){}$,:._<>")
_SHOWN = 40
_BRACKETS = {
    '"': ("quotation mark", '"'),
    "{": ("brace", "}"),
    "<": ("angle bracket", ">"),
    "⟨": ("angle bracket", "⟩"),
}
_EXAMPLE = 'write a form like (find (λ$1:e (is_a $1 "cereal")))'


def read_form(text: str, position: Position | None = None) -> Form:
    """Read a logical form in any of the three notations.

    Args:
        text: one form; λ or ``lambda``, spacing, ``:`` and ``.`` after a variable are free.
        position: the position of the first character of ``text`` in its source.

    Returns:
        A λ, an application or ``UNKNOWN``, with every variable bound.

    Raises:
        LanguageError: with the position, for text that is not a form, for a variable that no λ binds,
            and for a text, a name, a number or a nesting beyond ``limits``.
    """
    return _read_at(plain_marks(text), position, (Lambda, Application, Unknown))


def read_or_none(text: str) -> Form | None:
    """Return the form that a text writes; None where it is not a form."""
    try:
        return read_form(text)
    except LanguageError:
        return None


def plain_marks(text: str) -> str:
    """Return a form with plain quotation marks and brackets for those of word processors, phones and East Asian fonts.

    What stands between quotation marks stays. Each character stays in its place.
    """
    return text if text.isascii() else _TYPESET.sub(_plain_mark, text)


def _plain_mark(match: re.Match[str]) -> str:
    written = match[0]
    if written[0] == '"':
        return written
    return f'"{written[1:-1]}"' if len(written) > 1 else written.translate(_PLAIN)


def read_template_form(text: str, position: Position | None = None) -> Form:
    """Read the right side of a template as ``read_form`` does; it may also be one nonterminal, ``$action``."""
    return _read_at(plain_marks(text), position, (Lambda, Application, Unknown, Nonterminal))


def _read_at(text: str, position: Position | None, wanted: tuple[type, ...]) -> Form:
    try:
        form = _read(text)
        if not isinstance(form, wanted):
            raise LanguageError(
                "this is an argument, not a logical form",
                Offsets(text).position(len(text) - len(text.lstrip())),
                'write a predicate around it, as in (go "kitchen"), or UNKNOWN',
            )
    except LanguageError as error:
        place = error.position.inside(position) if position else error.position
        raise LanguageError(error.message, place, error.hint) from None
    return form


@lru_cache(maxsize=1 << 16)
def _read(text: str) -> Form:
    require_length(text, "form", MAX_FORM, Position())
    require_writable(text, Position())
    start = start_rule(text)
    try:
        form: Form = _form_reader().parse(text, start=start)  # type: ignore[assignment]
    except UnexpectedInput as error:
        raise explain(error, text) from None
    _refuse_unbound(form, text, start)
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
        if name.type == "NONTERMINAL":
            return self.nonterminal(name)
        require_name(name, "predicate", MAX_PREDICATE, _start(name))
        return str(name)

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

    def reference(self, word: Token) -> Reference:
        return Reference(str(word))

    def slot(self, braces: Token) -> Wildcard:
        return read_wildcard(str(braces), _start(braces))

    def nonterminal(self, name: Token) -> Nonterminal:
        require_name(name[1:], "nonterminal", MAX_NONTERMINAL, _start(name))
        return Nonterminal(name[1:])


@cache
def _form_reader() -> Lark:
    # Not before a form is read: it takes a tenth of a second.
    return _reader(transformer=_Builder())


@cache
def _tree_reader() -> Lark:
    return _reader(propagate_positions=True)


def _reader(**options: Any) -> Lark:
    grammar = Path(__file__).with_name("logic.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", start=["expression", "reading"], **options)


def _index(variable: Token) -> int:
    """Return the number of a variable: ``$2`` and ``y`` are 2, ``x4`` is 4."""
    if variable.startswith("$"):
        return int(variable[1:])
    return int(variable[1:]) if variable[1:] else "xyz".index(variable) + 1


def start_rule(text: str) -> str:
    """Return the rule of ``logic.lark`` that reads a text in its notation.

    Raises:
        LanguageError: the text nests too deep, by its brackets alone, for anything recursive.
    """
    start = "expression" if text.lstrip().startswith("(") else "reading"
    deepening = ("call", "reach") if start == "reading" else ("call", "open")
    level = 0
    outer: list[int] = []
    for match in _NESTING.finditer(text):
        if match["call"] or match["open"]:
            outer.append(level)
        elif match["close"]:
            level = outer.pop() if outer else 0
        level += match.lastgroup in deepening
        if level > MAX_NESTING:
            raise LanguageError(
                f"the form nests more than {MAX_NESTING} deep",
                Offsets(text).position(match.start()),
                "split it, or close a parenthesis earlier",
            )
    return start


def _refuse_unbound(form: Form, text: str, start: str) -> None:
    """Refuse a variable that no λ binds.

    Terms have no positions, so the n-th variable of the form is looked up as the n-th token.
    """
    number = next((n for n, is_bound in enumerate(_occurrences(form)) if not is_bound), None)
    if number is None:
        return
    lexed = _form_reader().parse_interactive(text, start=start).iter_parse()
    names: Iterable[Token] = (token for token in lexed if token.type in ("VARIABLE", "LETTER"))
    token = next(islice(names, number, None))
    raise LanguageError(
        f"no λ binds the variable {token}",
        _start(token),
        f"write (λ${_index(token)}:e …) around it, or use the variable of a λ that is already there",
    )


def _occurrences(form: Form, bound: frozenset[int] = frozenset()) -> Iterator[bool]:
    """Yield for each variable as written, including those after a λ, whether it is bound."""
    if isinstance(form, Lambda):
        yield True
        bound |= {form.variable}
    elif isinstance(form, Variable):
        yield form.index in bound
    for child in children(form):
        yield from _occurrences(child, bound)


def _start(token: Token) -> Position:
    return Position("", token.line or 1, token.column or 1)


@dataclass(frozen=True, slots=True)
class TermSpan:
    """A subterm: the characters ``start`` to ``end`` that write it, and its parts in order.

    ``kind`` is the rule of ``logic.lark`` that reads it (abstraction, application, variable, …);
    ``name`` is the predicate of an application or the variable, and begins at ``name_start``.
    """

    kind: str
    start: int
    end: int
    name: str
    name_start: int
    children: tuple[TermSpan, ...] = ()

    @property
    def name_end(self) -> int:
        return self.name_start + len(self.name)

    def walk(self) -> Iterator[TermSpan]:
        """Yield this span and those inside it in the order in which ``walk`` yields the terms."""
        yield self
        for child in self.children:
            yield from child.walk()


@lru_cache(maxsize=1 << 10)
def read_spans(text: str) -> TermSpan:
    """Return the spans of a form in any notation; variables need not be bound.

    Raises:
        LanguageError: the text is not a form.
    """
    text = plain_marks(text)
    start = start_rule(text)
    try:
        return _span(_tree_reader().parse(text, start=start))
    except UnexpectedInput as error:
        raise explain(error, text) from None


def _span(tree: Tree[Token]) -> TermSpan:
    first = tree.children[0]
    name = first.children[0] if isinstance(first, Tree) and first.data == "head" else first
    assert isinstance(name, Token)
    children = tuple(
        _span(each) for each in tree.children if isinstance(each, Tree) and each.data != "head"
    )
    meta = tree.meta
    return TermSpan(
        str(tree.data), meta.start_pos, meta.end_pos, str(name), name.start_pos or 0, children
    )


def explain(error: UnexpectedInput, text: str) -> LanguageError:
    """Return lark's error as a sentence with the place and what to do."""
    if not text.strip():
        return LanguageError("there is no form here", Position(), "write one, or UNKNOWN")
    offset = error.pos_in_stream or 0
    place = Offsets(text).position(offset)
    if isinstance(error, UnexpectedCharacters):
        character = text[offset]
        name, closing = _BRACKETS.get(character, ("", ""))
        if name and closing not in text[offset + 1 :]:
            return LanguageError(f"the {name} {character} is not closed", place, "close it")
        return LanguageError(f"{character} is not allowed here", place, _EXAMPLE)
    token: Token = error.token  # type: ignore[attr-defined]
    if token.type == "$END":
        end = Offsets(text).position(len(text.rstrip()))
        return LanguageError("the form ends too early", end, "close every parenthesis")
    shown = token if len(token) <= _SHOWN else f"{token[:_SHOWN]}…"
    if not error.expected:  # type: ignore[attr-defined]
        return LanguageError(f"{shown} follows the end of the form", place, "remove it")
    is_class = token.type == "CLASS_TOKEN"
    hint = f'put it in quotation marks: "{shown}"' if is_class else _EXAMPLE
    return LanguageError(f"{shown} is not allowed here", place, hint)
