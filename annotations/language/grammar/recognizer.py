"""Decide whether a grammar derives a command, with a chart and without enumerating commands.

The chart remembers, for each rule and each place in the command, where that rule can end. The time
is polynomial in the length of the command, however many commands the grammar has (after Earley, "An
efficient context-free parsing algorithm", CACM 1970; top-down with one word of look-ahead, which is
enough for grammars without recursion).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, reduce
from typing import TypeAlias

from annotations.language.forms import Choice, Nonterminal, Symbols, Text, Wildcard
from annotations.language.grammar.budget import Budget
from annotations.language.grammar.expander import Expander, Part, anonymized
from annotations.language.grammar.grammar import ROOT, Grammar
from annotations.language.grammar.lattice import Lattice


@dataclass(frozen=True, slots=True)
class Run:
    """Words next to each other. ``leaves`` are what they are in the grammar, where the chart is asked for it."""

    words: tuple[str, ...]
    leaves: tuple[Text | Wildcard, ...] = ()


# A run of words, or the number of a rule.
Item: TypeAlias = "Run | int"
Alternative: TypeAlias = "tuple[Item, ...]"

# A rule that can begin with more words than this is not looked up by its first word: the tables would be too large.
MOST_FIRST_WORDS = 1_000
# Commands of which a recogniser remembers what it said.
MOST_JUDGED = 20_000
# A sequence with more choices than this is not looked at with its nonterminals as they are.
MOST_SENTENTIAL_FORMS = 2_000
NOTHING: frozenset[str] = frozenset()
NOWHERE: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class ChartRule:
    """A nonterminal, a choice or a template's pattern, ready for matching.

    ``by_word`` maps a word to the alternatives that can begin with it. ``always`` are tried at
    every word: they can be empty, or can begin with more than ``MOST_FIRST_WORDS`` words. ``first``
    are the words that the rule can begin with (None: too many), ``needed`` those that are in all it becomes,
    ``names`` the nonterminals inside, and ``wildcards`` the names of the wildcards inside, where runs have leaves.
    """

    name: str
    by_word: dict[str, tuple[Alternative, ...]]
    always: tuple[Alternative, ...]
    first: frozenset[str] | None
    needed: frozenset[str]
    can_be_empty: bool
    names: frozenset[str]
    wildcards: frozenset[str]
    alternatives: tuple[Alternative, ...]

    def candidates(self, word: str) -> tuple[Alternative, ...]:
        found = self.by_word.get(word, ())
        return found + self.always if self.always else found


class RuleBook:
    """The rules of a grammar, numbered when they are first needed.

    Args:
        expander: into words, or into leaves, which the runs of the chart then know.
        lines: nonterminal → patterns that stand in place of its alternatives, each of them a rule of its own.
    """

    def __init__(
        self,
        expander: Expander[str] | Expander[Text | Wildcard],
        lines: Mapping[str, Sequence[Symbols]] | None = None,
    ) -> None:
        self._expander = expander
        self._lines = lines or {}
        self.line_rules: dict[str, tuple[int, ...]] = {}
        self._numbers: dict[Nonterminal | Choice, int] = {}
        self.rules: list[ChartRule] = []

    def number(self, symbol: Nonterminal | Choice) -> int:
        """Return the number of a symbol's rule. A new rule is made together with all rules below it."""
        if symbol not in self._numbers:
            name = symbol.name if isinstance(symbol, Nonterminal) else ""
            if name in self._lines:
                self.line_rules[name] = tuple(map(self.add_pattern, self._lines[name]))
                alternatives: list[Alternative] = [(rule,) for rule in self.line_rules[name]]
            else:
                alternatives = [self._items(parts) for parts in self._expander.rules(symbol)]
            self._numbers[symbol] = self._add(name, alternatives)
        return self._numbers[symbol]

    def add_pattern(self, pattern: Symbols) -> int:
        """Add a rule for a sequence that is not in any production, and return its number."""
        return self._add("", [self._items(self._expander.parts(pattern))])

    def add_choice(self, rules: Iterable[int]) -> int:
        """Add a rule that is one of several others, and return its number."""
        return self._add("", [(rule,) for rule in rules])

    def _items(self, parts: tuple[Part[str] | Part[Text | Wildcard], ...]) -> Alternative:
        items = (_run(part) if isinstance(part, tuple) else self.number(part) for part in parts)
        return tuple(item for item in items if isinstance(item, int) or item.words)

    def _add(self, name: str, alternatives: list[Alternative]) -> int:
        by_word: dict[str, list[Alternative]] = {}
        always: list[Alternative] = []
        first: set[str] = set()
        names = {name} - {""}
        wildcards: set[str] = set()
        firsts = [self._first(alternative) for alternative in alternatives]
        for alternative, (words, can_be_empty) in zip(alternatives, firsts, strict=True):
            first |= words or set()
            if can_be_empty or words is None:
                always.append(alternative)
            else:
                for word in words:
                    by_word.setdefault(word, []).append(alternative)
            for item in alternative:
                if isinstance(item, int):
                    names |= self.rules[item].names
                    wildcards |= self.rules[item].wildcards
                else:
                    wildcards.update(
                        leaf.name for leaf in item.leaves if isinstance(leaf, Wildcard)
                    )
        table = {word: tuple(beginning) for word, beginning in by_word.items()}
        has_many = len(first) > MOST_FIRST_WORDS or any(words is None for words, _ in firsts)
        is_nullable = any(can_be_empty for _, can_be_empty in firsts)
        known = None if has_many else frozenset(first)
        self.rules.append(
            ChartRule(
                *(name, table, tuple(always), known, self._needed(alternatives), is_nullable),
                *(frozenset(names), frozenset(wildcards), tuple(alternatives)),
            )
        )
        return len(self.rules) - 1

    def _needed(self, alternatives: Iterable[Alternative]) -> frozenset[str]:
        """Return the words that stand in everything that one of some alternatives becomes."""
        of_each = (
            frozenset().union(
                *(
                    self.rules[item].needed if isinstance(item, int) else item.words
                    for item in items
                )
            )
            for items in alternatives
        )
        return reduce(frozenset.intersection, of_each, next(of_each, NOTHING))

    def _first(self, alternative: Alternative) -> tuple[set[str] | None, bool]:
        """Return the words it can begin with (None: too many) and whether it can be empty."""
        words: set[str] | None = set()
        for item in alternative:
            if isinstance(item, Run):
                return None if words is None else words | {item.words[0]}, False
            rule = self.rules[item]
            words = None if words is None or rule.first is None else words | rule.first
            if not rule.can_be_empty:
                return words, False
        return words, True


def _run(part: tuple[str, ...] | tuple[Text | Wildcard, ...]) -> Run:
    leaves = tuple(leaf for leaf in part if isinstance(leaf, str) or _word(leaf))
    words = tuple(leaf if isinstance(leaf, str) else _word(leaf) for leaf in leaves)
    return Run(words, tuple(leaf for leaf in leaves if not isinstance(leaf, str)))


def _word(leaf: Text | Wildcard) -> str:
    return leaf.value if isinstance(leaf, Text) else leaf.token


class Chart:
    """What the rules of a rule book match in one lattice; filled on demand."""

    def __init__(self, book: RuleBook, lattice: Lattice, budget: Budget | None = None) -> None:
        self.rules = book.rules
        self.lattice = lattice
        self.budget = budget or Budget()
        self._ends: dict[tuple[int, int], frozenset[int]] = {}

    def ends(self, item: Item, start: int) -> frozenset[int]:
        """Return the places where an item that begins at ``start`` can end."""
        if isinstance(item, Run):
            return self.lattice.ends(item.words, start)
        key = (item, start)
        found = self._ends.get(key)
        if found is None:
            found = NOWHERE
            for alternative in self.candidates(item, start):
                found |= self._ends_of(alternative, start)
            self._ends[key] = found
        return found

    def has_needed(self, rule: int) -> bool:
        """Return whether the lattice has all the words that a rule cannot do without, wherever they stand."""
        return self.rules[rule].needed <= self.lattice.words

    def candidates(self, rule: int, start: int) -> Sequence[Alternative]:
        """Return the alternatives of a rule that can begin at ``start``, each once."""
        book = self.rules[rule]
        words = self.lattice.words_from(start)
        if len(words) == 1:
            return book.candidates(words[0])
        beginning = (each for word in words for each in book.by_word.get(word, ()))
        return tuple(dict.fromkeys((*beginning, *book.always)))

    def _ends_of(self, alternative: Alternative, start: int) -> frozenset[int]:
        reached = frozenset((start,))
        for item in alternative:
            self.budget.spend(1 + len(reached))
            if len(reached) == 1:
                reached = self.ends(item, *reached)
            else:
                reached = frozenset().union(*(self.ends(item, place) for place in reached))
            if not reached:
                break
        return reached


class WordChart:
    """What the rules of a rule book match in words: a ``Chart`` of the lattice with one path, in a fraction of the
    time. It counts the ways, whatever nonterminals became, up to ``most`` of them.
    """

    def __init__(
        self, book: RuleBook, words: tuple[str, ...], most: int = 1, budget: Budget | None = None
    ) -> None:
        self._rules = book.rules
        self._words = words
        self._distinct = frozenset(words)
        self._most = most
        self._budget = budget or Budget()
        self._ways: dict[tuple[int, int], dict[int, int]] = {}

    def ways(self, rule: int) -> int:
        """Return in how many ways a rule becomes the words."""
        return self._ends(rule, 0).get(len(self._words), 0)

    def _ends(self, rule: int, start: int) -> dict[int, int]:
        """Return each place where a rule that begins at ``start`` can end, with the number of ways there."""
        key = rule, start
        if (ends := self._ways.get(key)) is not None:
            return ends
        ends = {}
        if self._rules[rule].needed <= self._distinct:
            word = self._words[start] if start < len(self._words) else ""
            for alternative in self._rules[rule].candidates(word):
                for end, ways in self._ends_of(alternative, start).items():
                    ends[end] = min(self._most, ends.get(end, 0) + ways)
        self._ways[key] = ends
        return ends

    def _ends_of(self, alternative: Alternative, start: int) -> dict[int, int]:
        reached = {start: 1}
        steps = 0
        for item in alternative:
            steps += 1 + len(reached)
            if isinstance(item, Run):
                run, length = item.words, len(item.words)
                reached = {
                    place + length: ways
                    for place, ways in reached.items()
                    if self._words[place : place + length] == run
                }
            else:
                following: dict[int, int] = {}
                for place, ways in reached.items():
                    for end, inner in self._ends(item, place).items():
                        following[end] = min(self._most, following.get(end, 0) + ways * inner)
                reached = following
            if not reached:
                break
        self._budget.spend(steps)
        return reached


class Recognizer:
    """Accepts exactly the anonymized commands of a grammar, or what another nonterminal than its root becomes.

    A command has words; what another nonterminal becomes may have none.

    Raises:
        LanguageError: the grammar has a cycle.
    """

    def __init__(self, grammar: Grammar, root: str = ROOT) -> None:
        self._book = RuleBook(grammar.expander)
        self._root = self._book.number(Nonterminal(root))
        self._accepts_nothing = root != ROOT and self._book.rules[self._root].can_be_empty
        self._judged: dict[str, bool] = {}

    def accepts(self, command: str, budget: Budget | None = None) -> bool:
        """Return whether the grammar derives the command, given as words between spaces.

        Raises:
            TooManyCombinations: the budget is spent.
        """
        is_accepted = self._judged.get(command)
        if is_accepted is None:
            is_accepted = self._accepts(tuple(command.split()), budget)
            if len(self._judged) >= MOST_JUDGED:
                self._judged.clear()
            self._judged[command] = is_accepted
        return is_accepted

    def _accepts(self, words: tuple[str, ...], budget: Budget | None) -> bool:
        if not words:
            return self._accepts_nothing
        return bool(WordChart(self._book, words, budget=budget).ways(self._root))


@lru_cache(maxsize=16)
def recognizer_of(grammar: Grammar, root: str = ROOT) -> Recognizer:
    """Return the recogniser of a grammar, which all share who ask of the same productions. Raises as it does."""
    return Recognizer(grammar, root)


class SententialForms:
    """Says what a grammar derives of words and nonterminals together, which need not be expanded for it.

    Raises:
        LanguageError: the grammar has a cycle.
    """

    def __init__(self, grammar: Grammar) -> None:
        grammar.require_finite()
        self._book = RuleBook(
            Expander(lambda name: (*grammar.alternatives(name), (_as_word(name),)), anonymized)
        )
        self._words: Expander[str] = Expander(lambda name: ((_as_word(name),),), anonymized)

    def derives(self, root: str, sequence: Symbols) -> bool:
        """Return whether ``$root`` derives a sequence, whichever alternatives of its choices one takes.

        So it derives all that the sequence becomes. False also where there are too many choices to look at.
        """
        if self._words.size(sequence) > MOST_SENTENTIAL_FORMS:
            return False
        rule = self._book.number(Nonterminal(root))
        forms = self._words.stream(sequence)
        return all(WordChart(self._book, words).ways(rule) for words, _ in forms)


def _as_word(name: str) -> Text:
    """Return what stands for a nonterminal that is not expanded: no word has a space."""
    return Text(f" ${name}")
