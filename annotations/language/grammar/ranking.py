"""Number the derivations of a grammar: count them without enumeration, and go from a number to a derivation.

A rule with alternatives adds the counts of these; a sequence multiplies the counts of its parts and reads a
number as digits in mixed radix (Hickey and Cohen, "Uniform random generation of strings in a context-free
language", SIAM J. Comput. 1983; McKenzie, "Generating strings at random from a context free grammar", 1997).
All counts are exact integers, so that 10¹⁰⁰ derivations are numbered as easily as ten.

Nonterminals that have to become the same wherever they stand are *atoms*: a derivation says where they stand,
and something else says what they became. Derivations are therefore counted apart for each set of atoms.

The numbering does not depend on the order of lines or alternatives: these are sorted by their texts first.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator
from itertools import accumulate
from typing import TypeAlias

from annotations.language.forms import Choice, Nonterminal, Symbol, Symbols, Text, Wildcard
from annotations.language.grammar.budget import Budget
from annotations.language.grammar.expander import Expander, Part, anonymized

# A set of atoms, one bit each.
Atoms: TypeAlias = int
Counts: TypeAlias = "dict[Atoms, int]"
# Which alternative each rule took, in the order in which the rules are met from left to right.
Choices: TypeAlias = "tuple[int, ...]"


STEPS_PER_JOIN = 4  # what joining two sets of atoms costs in steps of a budget


class Cursor:
    """Reads choices one after the other; ``place`` is that of the next one."""

    def __init__(self, choices: Choices) -> None:
        self._choices = choices
        self.place = 0

    def take(self) -> int:
        """Return the next choice."""
        self.place += 1
        return self._choices[self.place - 1]


class RankedSequence:
    """A sequence whose derivations are numbered. ``counts`` are set of atoms → derivations with just these."""

    def __init__(
        self, parts: tuple[_Part, ...], source: tuple[Part[str], ...], budget: Budget
    ) -> None:
        self.parts = parts
        self.source = source
        self.text = " ".join(map(_text_of, parts))
        # ``_rests[i]`` counts what the parts from i on become.
        self._rests: list[Counts] = [{0: 1}]
        for part in reversed(parts):
            rest = self._rests[0]
            if isinstance(part, tuple):
                self._rests.insert(0, rest)
                continue
            counts: Counts = {}
            budget.spend(STEPS_PER_JOIN * len(part.counts) * len(rest))
            for own, n_own in part.counts.items():
                for other, n_other in rest.items():
                    counts[own | other] = counts.get(own | other, 0) + n_own * n_other
            self._rests.insert(0, dict(sorted(counts.items())))
        self.counts: Counts = self._rests[0]

    def choices(self, atoms: Atoms, rank: int) -> Choices:
        """Return derivation ``rank`` of those with just these ``atoms``; 0 ≤ rank < counts[atoms]."""
        taken: list[int] = []
        self.append_choices(atoms, rank, taken)
        return tuple(taken)

    def append_choices(self, atoms: Atoms, rank: int, taken: list[int]) -> None:
        for index, part in enumerate(self.parts):
            if isinstance(part, tuple):
                continue
            own, atoms, n_rest, rank = self._divide(index, part, atoms, rank)
            own_rank, rank = divmod(rank, n_rest)
            part.append_choices(own, own_rank, taken)

    def _divide(
        self, index: int, part: RankedRule, atoms: Atoms, rank: int
    ) -> tuple[Atoms, Atoms, int, int]:
        """Return the atoms of a part and of the rest, the count of the rest, and the rank among these."""
        rest = self._rests[index + 1]
        for own, n_own in part.counts.items():
            for other, n_other in rest.items():
                if own | other == atoms:
                    if rank < n_own * n_other:
                        return own, other, n_other, rank
                    rank -= n_own * n_other
        raise IndexError("there are not so many derivations")

    def spell(self, choices: Cursor) -> Iterator[tuple[str, ...] | str]:
        """Yield runs of words, and the names of atoms where these stand."""
        for part in self.parts:
            if isinstance(part, tuple):
                yield part
            else:
                yield from part.spell(choices)


class RankedRule:
    """A nonterminal or a choice: one of several sequences, or an atom, which stands for itself."""

    def __init__(self, text: str, sequences: Iterable[RankedSequence], atom: Atoms = 0) -> None:
        self.atom = atom
        self.name = text.removeprefix("$")
        self.text = text
        self.sequences = sorted(sequences, key=lambda each: each.text)
        counts: Counts = {atom: 1} if atom else {}
        for sequence in self.sequences:
            for atoms, count in sequence.counts.items():
                counts[atoms] = counts.get(atoms, 0) + count
        self.counts: Counts = {atoms: count for atoms, count in sorted(counts.items()) if count}
        self._ends: dict[Atoms, list[int]] = {
            atoms: list(accumulate(each.counts.get(atoms, 0) for each in self.sequences))
            for atoms in self.counts
        }

    def append_choices(self, atoms: Atoms, rank: int, taken: list[int]) -> None:
        if self.atom:
            return
        ends = self._ends[atoms]
        number = bisect_right(ends, rank)
        taken.append(number)
        before = ends[number - 1] if number else 0
        self.sequences[number].append_choices(atoms, rank - before, taken)

    def choices(self, atoms: Atoms, rank: int) -> Choices:
        """Return derivation ``rank`` of those with just these ``atoms``; 0 ≤ rank < counts[atoms]."""
        taken: list[int] = []
        self.append_choices(atoms, rank, taken)
        return tuple(taken)

    def spell(self, choices: Cursor) -> Iterator[tuple[str, ...] | str]:
        """Yield runs of words, and the names of atoms where these stand."""
        if self.atom:
            yield self.name
        else:
            yield from self.sequences[choices.take()].spell(choices)


_Part: TypeAlias = "tuple[str, ...] | RankedRule"


class Ranking:
    """The numbered rules of one grammar, each made when it is first needed.

    Args:
        alternatives: nonterminal → its alternatives; those that become the same words are merged.
        atoms: the nonterminals that are left as they are, in the order of their bits.
        budget: for counting; only many atoms in choices next to each other cost much.
    """

    def __init__(
        self,
        alternatives: Callable[[str], tuple[Symbols, ...]],
        atoms: tuple[str, ...],
        budget: Budget,
    ) -> None:
        self.atoms = atoms
        self._alternatives = alternatives
        self._expander = Expander(alternatives, anonymized)
        self._budget = budget
        self._bits = {name: 1 << number for number, name in enumerate(atoms)}
        self._rules: dict[Nonterminal | Choice, RankedRule] = {}
        self._bodies: dict[str, RankedRule] = {}

    def sequence(self, symbols: Symbols) -> RankedSequence:
        """Return a sequence with its derivations numbered. Raises TooManyCombinations."""
        return self._sequence(self._expander.parts(symbols))

    def body(self, name: str) -> RankedRule:
        """Return what the atom ``name`` becomes. Raises TooManyCombinations."""
        if name not in self._bodies:
            self._bodies[name] = self._make(Nonterminal(name))
        return self._bodies[name]

    def bit(self, name: str) -> Atoms:
        """Return the set of the atom ``name`` alone."""
        return self._bits[name]

    def narrow(self, symbols: Symbols, choices: Cursor) -> Symbols:
        """Return a sequence that has just the derivation with these ``choices``, with its wildcards.

        Where several alternatives become the same words, it has a choice of these.
        """
        narrowed: list[Symbol] = []
        for symbol in symbols:
            is_atom = isinstance(symbol, Nonterminal) and symbol.name in self._bits
            if isinstance(symbol, Text | Wildcard) or is_atom:
                narrowed.append(symbol)
            else:
                narrowed.append(Choice(self._narrow_rule(symbol, self._rule(symbol), choices)))
        return tuple(narrowed)

    def narrow_body(self, name: str, choices: Cursor) -> tuple[Symbols, ...]:
        """Return the alternatives of the atom ``name`` that ``choices`` stand for, as ``narrow`` does."""
        return self._narrow_rule(Nonterminal(name), self.body(name), choices)

    def _narrow_rule(
        self, symbol: Nonterminal | Choice, rule: RankedRule, choices: Cursor
    ) -> tuple[Symbols, ...]:
        taken = rule.sequences[choices.take()].source
        start = choices.place
        narrowed: dict[Symbols, None] = {}
        alternatives = (
            symbol.alternatives if isinstance(symbol, Choice) else self._alternatives(symbol.name)
        )
        for alternative in alternatives:
            if self._expander.parts(alternative) == taken:
                choices.place = start  # equal ones take the same choices
                narrowed[self.narrow(alternative, choices)] = None
        return tuple(narrowed)

    def _sequence(self, parts: tuple[Part[str], ...]) -> RankedSequence:
        ranked = tuple(part if isinstance(part, tuple) else self._rule(part) for part in parts)
        return RankedSequence(ranked, parts, self._budget)

    def _rule(self, symbol: Nonterminal | Choice) -> RankedRule:
        if symbol not in self._rules:
            if isinstance(symbol, Nonterminal) and symbol.name in self._bits:
                self._rules[symbol] = RankedRule(str(symbol), (), self._bits[symbol.name])
            else:
                self._rules[symbol] = self._make(symbol)
        return self._rules[symbol]

    def _make(self, symbol: Nonterminal | Choice) -> RankedRule:
        sequences = [self._sequence(parts) for parts in self._expander.rules(symbol)]
        text = str(symbol)
        if isinstance(symbol, Choice):
            text = f"({' | '.join(sorted(each.text for each in sequences))})"
        return RankedRule(text, sequences)


def _text_of(part: _Part) -> str:
    return " ".join(part) if isinstance(part, tuple) else part.text
