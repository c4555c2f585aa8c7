"""The symbols of a command grammar: words, nonterminals, wildcards and choices (frozen values)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

# Kinds of wildcards that stand for no entity.
NO_ENTITY = ("void", "pron")
# Wildcard name as written → (kind, type). docs/reference/formats.md, Wildcards.
ALIASES: dict[str, tuple[str, str]] = {
    "kobject": ("object", "known"),
    "aobject": ("object", "alike"),
    "sobject": ("object", "special"),
    "room": ("location", "room"),
    "placement": ("location", "placement"),
    "beacon": ("location", "beacon"),
    "male": ("name", "male"),
    "female": ("name", "female"),
}
# Kind → its types; other kinds have none.
TYPES: dict[str, tuple[str, ...]] = {
    "object": ("known", "alike", "special"),
    "location": ("room", "placement", "beacon"),
    "name": ("male", "female"),
    "pron": ("obj", "sub", "pos", "paj", "posadj", "pab", "posabs"),
}


@dataclass(frozen=True, slots=True)
class Text:
    """One word, or a comma, as it stands in a command."""

    value: str


@dataclass(frozen=True, slots=True)
class Nonterminal:
    """``$name``; ``name`` is without the dollar sign."""

    name: str

    def __str__(self) -> str:
        return f"${self.name}"


@dataclass(frozen=True, slots=True)
class Comparison:
    """``property operator value`` in a where clause; property is lower-cased."""

    property: str
    operator: str  # one of = != > >= < <=
    value: str | float | bool | Wildcard | None


@dataclass(frozen=True, slots=True)
class Negation:
    operand: Condition


@dataclass(frozen=True, slots=True)
class Combination:
    operator: str  # and, or, xor
    left: Condition
    right: Condition


Condition: TypeAlias = "Comparison | Negation | Combination"


@dataclass(frozen=True, slots=True)
class Wildcard:
    """``{name? type id where … meta: …}``: a value to draw from the ontology.

    ``name`` is the word as written (``kobject``, ``placement``). Two wildcards with the same name
    and the same given id are the same value (see ``identity``).
    """

    name: str
    type: str = ""
    id: int | None = None
    obfuscated: bool = False
    where: Condition | None = None
    meta: tuple[Symbol, ...] = ()

    @property
    def kind(self) -> str:
        """The kind after aliases: a class of entities (``room`` is a location), void or pron."""
        return ALIASES[self.name][0] if self.name in ALIASES else self.name

    @property
    def restriction(self) -> str:
        """The type after aliases (known, room, male, …), empty if there is none."""
        return self.type or (ALIASES[self.name][1] if self.name in ALIASES else "")

    @property
    def entity_class(self) -> str:
        """The class of its token: rooms are ``room``, beacons and placements ``location``; empty for void and pron."""
        if self.kind in NO_ENTITY:
            return ""
        return "room" if self.restriction == "room" else self.kind

    @property
    def token(self) -> str:
        """The word for it in an anonymized command: ``<class>``, ``them``, or none for void."""
        if self.kind == "pron":
            return "them"
        return f"<{self.entity_class}>" if self.entity_class else ""

    @property
    def identity(self) -> tuple[str, int | None]:
        return (self.name, self.id)


@dataclass(frozen=True, slots=True)
class Choice:
    """``( a | b )``: one of several sequences."""

    alternatives: tuple[tuple[Symbol, ...], ...]


Symbol: TypeAlias = "Text | Nonterminal | Wildcard | Choice"
Symbols: TypeAlias = "tuple[Symbol, ...]"


def walk_symbols(sequence: Symbols, notes: bool) -> Iterator[Text | Nonterminal | Wildcard]:
    """Yield every symbol of a sequence in order, including those inside choices, but not the choices.

    With ``notes`` it also enters the notes of wildcards.
    """
    for symbol in sequence:
        if isinstance(symbol, Choice):
            for alternative in symbol.alternatives:
                yield from walk_symbols(alternative, notes)
            continue
        yield symbol
        if notes and isinstance(symbol, Wildcard):
            yield from walk_symbols(symbol.meta, notes)
