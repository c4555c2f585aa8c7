"""Read the right side of a production, or the pattern of a template, into symbols."""

from __future__ import annotations

import re
from dataclasses import dataclass
from difflib import get_close_matches

from annotations.language.forms.cursor import Cursor
from annotations.language.forms.entity_classes import (
    DEFAULT_CLASSES,
    TOKEN,
    EntityClasses,
    wildcard_names,
)
from annotations.language.forms.symbols import (
    TYPES,
    Choice,
    Nonterminal,
    Symbol,
    Symbols,
    Text,
    Wildcard,
)
from annotations.language.forms.where_clauses import read_condition
from annotations.language.texts import MAX_NONTERMINAL, Position, require_name

_HEAD_WORD = re.compile(r"\w+")
# The generator reads letters and then digits: {object1} is {object 1}.
_LETTERS_BEFORE_ID = re.compile(r"[^\W\d]*[^\W\d_](?=\d++\b)")
_KEYWORD = re.compile(r"(where\b|meta\s*:)", re.IGNORECASE)
_NONTERMINAL = re.compile(r"\$([^\W\d]\w*)")
_SPECIAL = r"\s$\{\}()|,"
_WORD = re.compile(rf"(?:[^{_SPECIAL}\\]|\\.)+")
_META = re.compile(r"meta\s*:\s*", re.IGNORECASE)
_WHERE = re.compile(r"where\b\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class WildcardHead:
    """The parts before ``where`` and ``meta``."""

    name: str
    type: str = ""
    id: int | None = None
    obfuscated: bool = False


def read_head(cursor: Cursor, classes: EntityClasses | None = None) -> WildcardHead:
    """Read ``kind[?] [type] [id]`` and stop before ``where``, ``meta:`` or the closing brace.

    Args:
        classes: those that a kind may be of; None for any kind that is written like one.

    Raises:
        LanguageError: an unknown kind, a type its kind does not have, or an id too long.
    """
    cursor.skip_spaces()
    start = cursor.index
    written = cursor.match(_LETTERS_BEFORE_ID) or cursor.match(_HEAD_WORD)
    if written is None:
        names = wildcard_names(DEFAULT_CLASSES if classes is None else classes)
        raise cursor.fail("a wildcard needs a kind", f"one of {', '.join(names)}")
    name = written.lower()
    if classes is None:
        if not TOKEN.fullmatch(name):
            raise cursor.fail(*no_such_kind(written, DEFAULT_CLASSES), at=start)
    elif name not in wildcard_names(classes):
        raise cursor.fail(*no_such_kind(written, classes), at=start)
    cursor.skip_spaces()
    obfuscated = cursor.accept("?")
    type_ = ""
    identifier: int | None = None
    while (word := _next_word(cursor)) is not None:
        if word.isascii() and word.isdigit() and identifier is None and len(word) < 10:
            identifier = int(word)
        elif not type_ and word.lower() in TYPES.get(name, ()):
            type_ = word.lower()
        else:
            types = TYPES.get(name, ())
            offer = f"its types are {', '.join(types)}" if types else f"{{{name}}} has no types"
            raise cursor.fail(f"{word} is neither a type nor an id of {{{name}}}", offer)
        cursor.index += len(word)
    return WildcardHead(name, type_, identifier, obfuscated)


def no_such_kind(written: str, classes: EntityClasses) -> tuple[str, str]:
    """Return the message and the hint for a wildcard of a kind that is not of ``classes``."""
    names = wildcard_names(classes)
    near = get_close_matches(written.lower(), names, 1)
    listed = f"add a class {written}, or use one of {', '.join(names)}"
    hint = f"did you mean {{{near[0]}}}?" if near else listed
    return f"there is no wildcard {{{written}}}", hint


def _next_word(cursor: Cursor) -> str | None:
    cursor.skip_spaces()
    if _KEYWORD.match(cursor.text, cursor.index):
        return None
    match = _LETTERS_BEFORE_ID.match(cursor.text, cursor.index) or _HEAD_WORD.match(
        cursor.text, cursor.index
    )
    return None if match is None else match.group()


class SymbolReader(Cursor):
    """A recursive reader of one line; ``references`` collects the nonterminals it meets.

    Brackets are matched first, so the recursion never goes deeper than ``limits.MAX_NESTING``.
    ``classes`` are those that wildcards may be of; None for all.
    """

    def __init__(self, text: str, origin: Position, classes: EntityClasses | None = None) -> None:
        super().__init__(text, origin)
        self.classes = classes
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
        head = read_head(self, self.classes)
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
            if (
                lone
                or self.next == "|"
                or (self.next == "$" and not _NONTERMINAL.match(self.text, self.index))
            ):
                symbols.append(Text(self.next))
                self.index += 1
            else:
                symbols.extend(self.symbols())
            self.skip_spaces()
        return tuple(symbols)


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


def read_wildcard(
    text: str, position: Position | None = None, classes: EntityClasses | None = None
) -> Wildcard:
    """Read one wildcard with its braces, and nothing else.

    Args:
        text: like ``{placement 2 meta: Block access to {placement 2}}``.
        position: the position of its first character; the start of an unnamed text by default.
        classes: those that it may be of; None for any.

    Raises:
        LanguageError: the text is not exactly one well-formed wildcard.
    """
    reader = SymbolReader(text, position or Position(), classes)
    reader.skip_spaces()
    if reader.next != "{":
        raise reader.fail("a wildcard begins with {", "write it like {object 1}")
    wildcard = reader.wildcard()
    reader.skip_spaces()
    if reader.next:
        raise reader.fail("there is more than one wildcard here")
    return wildcard
