"""Hypothesis strategies for symbols and small grammars, and the naive expansion to compare with."""

from __future__ import annotations

from itertools import product

from hypothesis import assume
from hypothesis import strategies as st

from annotations.language.forms import (
    TYPES,
    Choice,
    Combination,
    Comparison,
    Negation,
    Nonterminal,
    Text,
    Wildcard,
)
from annotations.language.forms.reader import as_sequence
from annotations.language.forms.symbols import ALIASES
from annotations.language.grammar import Grammar, Production

NAMES = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,6}", fullmatch=True)
WORDS = st.one_of(
    st.just(Text(",")), st.text("ab'$#;%{}()|\\=/*-.:?\"é", min_size=1, max_size=5).map(Text)
)
VALUES = st.one_of(
    st.text('ab "\\{}();%#=,', max_size=6),
    st.floats(allow_nan=False, allow_infinity=False),
    st.booleans(),
    st.none(),
)
PROPERTIES = NAMES.map(str.lower).filter(lambda name: name not in ("and", "or", "xor", "not"))
CONDITIONS = st.recursive(
    st.builds(Comparison, PROPERTIES, st.sampled_from(["=", "!=", ">", ">=", "<", "<="]), VALUES),
    lambda inner: st.one_of(
        st.builds(Negation, inner.filter(lambda operand: not isinstance(operand, Negation))),
        st.builds(Combination, st.sampled_from(["and", "or", "xor"]), inner, inner),
    ),
    max_leaves=4,
)
NO_NOTE = st.just(())


@st.composite
def wildcards(draw, notes=NO_NOTE):
    name = draw(st.sampled_from([*TYPES, *ALIASES]))
    type_ = draw(st.sampled_from(["", *TYPES.get(name, ())]))
    identifier = draw(st.none() | st.integers(0, 12))
    where = draw(st.none() | CONDITIONS)
    return Wildcard(name, type_, identifier, draw(st.booleans()), where, draw(notes))


def _longer(sequences):
    """Sequences that may hold a choice between, or a note made of, the given ones."""
    choices = st.lists(sequences, min_size=2, max_size=3).map(as_sequence)
    pieces = st.one_of(sequences, choices, wildcards(sequences).map(lambda each: (each,)))
    return st.lists(pieces, min_size=1, max_size=3).map(lambda drawn: sum(drawn, ()))


SEQUENCES = st.recursive(
    st.one_of(WORDS, NAMES.map(Nonterminal), wildcards()).map(lambda symbol: (symbol,)),
    _longer,
    max_leaves=8,
)
EXPANSIONS = st.lists(SEQUENCES, min_size=1, max_size=3).map(as_sequence)

LEAVES = [
    Text("a"),
    Text("b"),
    Text(","),
    Wildcard("object"),
    Wildcard("kobject", id=1),
    Wildcard("beacon"),
    Wildcard("pron"),
    Wildcard("void"),
]
TOKENS = ["a", "b", ",", "<object>", "<location>", "them", "c"]
LAYERS = ("Main", "A", "B", "C")
# Derivations that an example may have, so that expanding it naively stays quick.
FEW = 300


@st.composite
def sequences_over(draw, names, depth=1):
    """A short sequence of leaves, of the nonterminals ``names`` and, down to ``depth``, of choices."""
    symbol = st.sampled_from([*LEAVES, *map(Nonterminal, names)])
    if depth:
        inner = st.lists(sequences_over(names, depth - 1), min_size=2, max_size=2)
        symbol = st.one_of(symbol, inner.map(lambda drawn: Choice(tuple(drawn))))
    return tuple(draw(st.lists(symbol, min_size=1, max_size=3)))


@st.composite
def small_grammars(draw):
    """Grammars without cycles; a nonterminal of any layer may be left undefined."""
    productions = []
    for number, name in enumerate(LAYERS):
        lower = LAYERS[number + 1 :]
        for expansion in draw(st.lists(sequences_over(lower), max_size=2 if number else 3)):
            productions.append(Production(name, expansion))
    grammar = Grammar(tuple(productions))
    assume(grammar.size() <= FEW)
    return grammar


def naive(grammar, sequence):
    """Every derivation of a sequence as (words, {(nonterminal, words), …}), one by one."""
    for pieces in product(*(list(_naive_symbol(grammar, symbol)) for symbol in sequence)):
        words = sum((piece[0] for piece in pieces), ())
        yield words, frozenset().union(*(piece[1] for piece in pieces))


def _naive_symbol(grammar, symbol):
    if isinstance(symbol, Text):
        yield (symbol.value,), frozenset()
    elif isinstance(symbol, Wildcard):
        yield ((symbol.token,) if symbol.token else ()), frozenset()
    elif isinstance(symbol, Choice):
        for alternative in symbol.alternatives:
            yield from naive(grammar, alternative)
    else:
        for production in grammar.productions:
            if production.nonterminal == symbol.name:
                for words, inner in naive(grammar, production.expansion):
                    yield words, inner | {(symbol.name, words)}
