"""Reads the right side of a production, or the pattern of a template, into symbols."""

from __future__ import annotations

import re

from annotations.language.conditions import read_condition
from annotations.language.cursor import Cursor
from annotations.language.errors import Position
from annotations.language.symbols import Choice, Nonterminal, Sequence, Symbol, Text, Wildcard
from annotations.language.wildcard_heads import read_head

_NONTERMINAL = re.compile(r"\$([^\W\d]\w*)")
_SPECIAL = r"\s$\{\}()|,"
_WORD = re.compile(rf"(?:[^{_SPECIAL}\\]|\\.)+")
_META = re.compile(r"meta\s*:\s*", re.IGNORECASE)
_WHERE = re.compile(r"where\b\s*", re.IGNORECASE)


class SymbolReader(Cursor):
    """A recursive reader of one line; ``references`` collects the nonterminals it meets.

    Brackets were matched before the first step, so recursion never passes ``brackets.MAX_DEPTH``.
    """

    def __init__(self, text: str, origin: Position) -> None:
        super().__init__(text, origin)
        self.references: list[tuple[str, Position]] = []

    def whole_line(self) -> Sequence:
        """The line as one sequence; alternatives at its top level become one Choice.

        Raises:
            LanguageError: an unbalanced choice, an empty alternative, a malformed wildcard.
        """
        found = self.alternatives()
        if self.next:
            raise self.fail(
                "this ) closes a choice that was never opened", "remove it or write \\) for itself"
            )
        return as_sequence(found)

    def wildcard(self) -> Wildcard:
        """The wildcard that begins at the next character, an opening brace."""
        end = self.pairs[self.index]
        self.accept("{")
        head = read_head(self)
        where = read_condition(self, self.wildcard) if self.match(_WHERE) is not None else None
        self.skip_spaces()
        meta = self.meta(end) if self.match(_META) is not None else ()
        if self.index != end:
            raise self.fail(
                f"the wildcard {{{head.name}}} does not go on like this",
                "its order is {kind? type id where condition meta: text}",
            )
        self.accept("}")
        return Wildcard(head.name, head.type, head.id, head.obfuscated, where, meta)

    def alternatives(self) -> list[Sequence]:
        found = [self.sequence()]
        while self.accept("|"):
            found.append(self.sequence())
        return found

    def sequence(self) -> Sequence:
        """Symbols up to a bar, a closing parenthesis or the end."""
        symbols: list[Symbol] = []
        self.skip_spaces()
        start = self.index
        while self.next not in ("", "|", ")"):
            symbols.extend(self.symbols())
            self.skip_spaces()
        if not symbols:
            raise self.fail(
                "an alternative is empty", "write {void} where nothing is said", at=start
            )
        return tuple(symbols)

    def symbols(self) -> Sequence:
        """The symbol that begins here; a parenthesis around one alternative is no symbol of its own."""
        if self.next == "{":
            return (self.wildcard(),)
        if self.next == "$":
            return (self.nonterminal(),)
        if self.next == "(":
            return self.choice()
        return (self.word(),)

    def choice(self) -> Sequence:
        opening = self.index
        if opening not in self.pairs:
            raise self.fail(
                "the choice opened here is never closed", "add a ) or write \\( for itself"
            )
        self.accept("(")
        found = self.alternatives()
        self.accept(")")
        return as_sequence(found)

    def nonterminal(self) -> Nonterminal:
        start = self.index
        found = self.match(_NONTERMINAL)
        if found is None:
            raise self.fail("a $ needs a name after it", "write \\$ for the character itself")
        self.references.append((found[1:], self.position(start)))
        return Nonterminal(found[1:])

    def word(self) -> Text:
        if self.accept(","):
            return Text(",")
        found = self.match(_WORD)
        if found is None:
            raise self.fail(
                "a \\ needs a character after it", "write \\\\ for the character itself"
            )
        return Text(re.sub(r"\\(.)", r"\1", found))

    def meta(self, end: int) -> Sequence:
        """The note up to the brace at ``end``. Lone parentheses, bars and $ signs are words in it."""
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


def as_sequence(alternatives: list[Sequence]) -> Sequence:
    """One sequence that stands for the alternatives; equal ones collapse, a lone one is spliced in.

    An alternative that is nothing but a Choice lends its own alternatives: ``(a | (b | c))`` and
    ``(a | b | c)`` are one value.
    """
    distinct: dict[Sequence, None] = {}
    for alternative in alternatives:
        only = alternative[0] if len(alternative) == 1 else None
        inner = only.alternatives if isinstance(only, Choice) else (alternative,)
        distinct.update(dict.fromkeys(inner))
    if len(distinct) == 1:
        return next(iter(distinct))
    return (Choice(tuple(distinct)),)
