"""Where the subterms of a form are in its text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from lark import Lark, Token, Tree, UnexpectedInput

from annotations.language.forms.errors import explain
from annotations.language.forms.logic import start_rule


@dataclass(frozen=True, slots=True)
class Span:
    """A subterm: the characters ``start`` to ``end`` that write it, and its parts in order.

    ``kind`` is the rule of ``logic.lark`` that reads it (abstraction, application, variable, …);
    ``name`` is the predicate of an application or the variable, and begins at ``name_start``.
    """

    kind: str
    start: int
    end: int
    name: str
    name_start: int
    children: tuple[Span, ...] = ()

    @property
    def name_end(self) -> int:
        return self.name_start + len(self.name)

    def walk(self) -> Iterator[Span]:
        """Yield this span and those inside it in the order in which ``walk`` yields the terms."""
        yield self
        for child in self.children:
            yield from child.walk()


@lru_cache(maxsize=1 << 10)
def read_spans(text: str) -> Span:
    """Return the spans of a form in any notation; variables need not be bound.

    Raises:
        LanguageError: the text is not a form.
    """
    start = start_rule(text)
    try:
        return _span(_tree_reader().parse(text, start=start))
    except UnexpectedInput as error:
        raise explain(error, text) from None


@lru_cache(maxsize=1)
def _tree_reader() -> Lark:
    grammar = Path(__file__).with_name("logic.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", start=["expression", "reading"], propagate_positions=True)


def _span(tree: Tree[Token]) -> Span:
    first = tree.children[0]
    name = first.children[0] if isinstance(first, Tree) and first.data == "head" else first
    assert isinstance(name, Token)
    children = tuple(
        _span(each) for each in tree.children if isinstance(each, Tree) and each.data != "head"
    )
    meta = tree.meta
    return Span(
        str(tree.data), meta.start_pos, meta.end_pos, str(name), name.start_pos or 0, children
    )
