"""Read the right side of a production, or the pattern of a template, into symbols."""

from __future__ import annotations

import re

from annotations.language.errors import Position
from annotations.language.limits import MAX_NONTERMINAL, require_name
from annotations.language.symbols.conditions import read_condition
from annotations.language.symbols.cursor import Cursor
from annotations.language.symbols.symbols import (
    Choice,
    Nonterminal,
    Symbol,
    Symbols,
    Text,
    Wildcard,
)
from annotations.language.symbols.wildcard_heads import read_head

_NONTERMINAL = re.compile(r"\$([^\W\d]\w*)")
_SPECIAL = r"\s$\{\}()|,"
_WORD = re.compile(rf"(?:[^{_SPECIAL}\\]|\\.)+")
_META = re.compile(r"meta\s*:\s*", re.IGNORECASE)
_WHERE = re.compile(r"where\b\s*", re.IGNORECASE)


class SymbolReader(Cursor):
    """A recursive reader of one line; ``references`` collects the nonterminals it meets.

    Brackets are matched first, so the recursion never goes deeper than ``limits.MAX_NESTING``.
    """

    def __init__(self, text: str, origin: Position) -> None:
        super().__init__(text, origin)
        self.references: list[tuple[str, Position]] = []

    def whole_line(self) -> Symbols:
        """Read the line as one sequence; top-level alternatives become one Choice.

        Raises:
            LanguageError: an unbalanced choice, an empty alternative, a malformed wildcard.
        """
        alternatives = self.alternatives()
        if self.next:
            raise self.fail(
                "this ) closes a choice that was never opened",
                "remove it, or write \\) for the character itself",
            )
        return as_sequence(alternatives)

    def wildcard(self) -> Wildcard:
        """Read the wildcard that begins at the next character, an opening brace."""
        end = self.pairs[self.index]
        self.accept("{")
        head = read_head(self)
        where = read_condition(self, self.wildcard) if self.match(_WHERE) is not None else None
        self.skip_spaces()
        meta = self.meta(end) if self.match(_META) is not None else ()
        if self.index != end:
            raise self.fail(
                f"the wildcard {{{head.name}}} has something that does not belong here",
                "the order of its parts is {kind? type id where condition meta: text}",
            )
        self.accept("}")
        return Wildcard(head.name, head.type, head.id, head.obfuscated, where, meta)

    def alternatives(self) -> list[Symbols]:
        sequences = [self.sequence()]
        while self.accept("|"):
            sequences.append(self.sequence())
        return sequences

    def sequence(self) -> Symbols:
        """Read symbols up to a bar, a closing parenthesis or the end."""
        symbols: list[Symbol] = []
        self.skip_spaces()
        start = self.index
        while self.next not in ("", "|", ")"):
            symbols.extend(self.symbols())
            self.skip_spaces()
        if not symbols:
            raise self.fail("an alternative is empty", "write {void} for no words", at=start)
        return tuple(symbols)

    def symbols(self) -> Symbols:
        """Read the symbol that begins here; parentheses around a single alternative are dropped."""
        if self.next == "{":
            return (self.wildcard(),)
        if self.next == "$":
            return (self.nonterminal(),)
        if self.next == "(":
            return self.choice()
        return (self.word(),)

    def choice(self) -> Symbols:
        opening = self.index
        if opening not in self.pairs:
            raise self.fail(
                "the choice opened here is never closed",
                "add a ), or write \\( for the character itself",
            )
        self.accept("(")
        alternatives = self.alternatives()
        self.accept(")")
        return as_sequence(alternatives)

    def nonterminal(self) -> Nonterminal:
        start = self.index
        name = self.match(_NONTERMINAL)
        if name is None:
            raise self.fail("a $ needs a name after it", "write \\$ for the character itself")
        require_name(name[1:], "nonterminal", MAX_NONTERMINAL, self.position(start))
        self.references.append((name[1:], self.position(start)))
        return Nonterminal(name[1:])

    def word(self) -> Text:
        if self.accept(","):
            return Text(",")
        word = self.match(_WORD)
        if word is None:
            raise self.fail(
                "a \\ needs a character after it", "write \\\\ for the character itself"
            )
        return Text(re.sub(r"\\(.)", r"\1", word))

    def meta(self, end: int) -> Symbols:
        """Read the note up to the brace at ``end``. Lone parentheses, bars and $ signs are words in it."""
        symbols: list[Symbol] = []
        self.skip_spaces()
        while self.index < end:
            lone = self.next == ")" or (self.next == "(" and self.index not in self.pairs)
            if lone or self.next == "|" or (self.next == "$" and not self._at_nonterminal()):
                symbols.append(Text(self.next))
                self.index += 1
            else:
                symbols.extend(self.symbols())
            self.skip_spaces()
        return tuple(symbols)

    def _at_nonterminal(self) -> bool:
        return _NONTERMINAL.match(self.text, self.index) is not None


def as_sequence(alternatives: list[Symbols]) -> Symbols:
    """Return one sequence for the alternatives; equal ones are merged, a single one stands for itself.

    An alternative that is only a Choice adds its own alternatives: ``(a | (b | c))`` and ``(a | b |
    c)`` are the same value.
    """
    distinct: dict[Symbols, None] = {}
    for alternative in alternatives:
        only = alternative[0] if len(alternative) == 1 else None
        inner = only.alternatives if isinstance(only, Choice) else (alternative,)
        distinct.update(dict.fromkeys(inner))
    if len(distinct) == 1:
        return next(iter(distinct))
    return (Choice(tuple(distinct)),)
