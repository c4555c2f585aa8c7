"""Is this command one of the grammar's? A chart recogniser that never enumerates.

The chart remembers, for each rule and each place in the command, where that rule can end: time is
polynomial in the length of the command whatever the number of commands (after Earley, "An efficient
context-free parsing algorithm", CACM 1970; top-down with one word of look-ahead, which is enough for
grammars without recursion).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from annotations.language.derivations import Expander
from annotations.language.grammar import ROOT, Grammar
from annotations.language.symbols import Choice, Nonterminal, Sequence

# A run of words, or the number of a rule.
Item: TypeAlias = "tuple[str, ...] | int"
Alternative: TypeAlias = "tuple[Item, ...]"


@dataclass(frozen=True, slots=True)
class Rule:
    """A nonterminal, a choice or a template's pattern, ready for matching.

    ``by_word`` has the alternatives that can begin with a word; ``nullable`` those that can be
    nothing at all, which are tried before any word. ``names`` are the nonterminals inside.
    """

    name: str
    by_word: dict[str, tuple[Alternative, ...]]
    nullable: tuple[Alternative, ...]
    names: frozenset[str]

    def candidates(self, word: str) -> tuple[Alternative, ...]:
        return self.by_word.get(word, self.nullable)


class RuleBook:
    """The rules of a grammar, numbered as they are first needed."""

    def __init__(self, expander: Expander[str]) -> None:
        self._expander = expander
        self._numbers: dict[Nonterminal | Choice, int] = {}
        self.rules: list[Rule] = []

    def number(self, symbol: Nonterminal | Choice) -> int:
        """The rule of a symbol, made with all below it where it is new."""
        if symbol not in self._numbers:
            name = symbol.name if isinstance(symbol, Nonterminal) else ""
            alternatives = [self._items(parts) for parts in self._expander.rules(symbol)]
            self._numbers[symbol] = self._add(name, alternatives)
        return self._numbers[symbol]

    def add_pattern(self, pattern: Sequence) -> int:
        """A rule of its own for a sequence that stands in no production."""
        return self._add("", [self._items(self._expander.parts(pattern))])

    def _items(self, parts: tuple[tuple[str, ...] | Nonterminal | Choice, ...]) -> Alternative:
        return tuple(part if isinstance(part, tuple) else self.number(part) for part in parts)

    def _add(self, name: str, alternatives: list[Alternative]) -> int:
        by_word: dict[str, list[Alternative]] = {}
        nullable: list[Alternative] = []
        names = {name} - {""}
        for alternative in alternatives:
            words, can_be_empty = self._first(alternative)
            for word in words:
                by_word.setdefault(word, list(nullable)).append(alternative)
            if can_be_empty:
                nullable.append(alternative)
                for word in by_word.keys() - words:
                    by_word[word].append(alternative)
            names.update(*(self.rules[item].names for item in alternative if isinstance(item, int)))
        table = {word: tuple(found) for word, found in by_word.items()}
        self.rules.append(Rule(name, table, tuple(nullable), frozenset(names)))
        return len(self.rules) - 1

    def _first(self, alternative: Alternative) -> tuple[set[str], bool]:
        """The words it can begin with, and whether it can be empty."""
        words: set[str] = set()
        for item in alternative:
            if isinstance(item, tuple):
                return words | {item[0]}, False
            words.update(self.rules[item].by_word)
            if not self.rules[item].nullable:
                return words, False
        return words, True


class Chart:
    """What the rules of a book match in one command; filled on demand."""

    def __init__(self, book: RuleBook, words: tuple[str, ...]) -> None:
        self.rules = book.rules
        self.words = words
        self._ends: dict[tuple[int, int], frozenset[int]] = {}

    def ends(self, item: Item, start: int) -> frozenset[int]:
        """The places (word counts) where an item that begins at ``start`` can end."""
        if isinstance(item, tuple):
            stop = start + len(item)
            return frozenset((stop,)) if self.words[start:stop] == item else frozenset()
        key = (item, start)
        if key not in self._ends:
            self._ends[key] = frozenset().union(
                *(self._ends_of(alternative, start) for alternative in self.candidates(item, start))
            )
        return self._ends[key]

    def candidates(self, rule: int, start: int) -> tuple[Alternative, ...]:
        word = self.words[start] if start < len(self.words) else ""
        return self.rules[rule].candidates(word)

    def _ends_of(self, alternative: Alternative, start: int) -> frozenset[int]:
        reached = frozenset((start,))
        for item in alternative:
            if len(reached) == 1:
                reached = self.ends(item, *reached)
            else:
                reached = frozenset().union(*(self.ends(item, place) for place in reached))
            if not reached:
                break
        return reached


class Recognizer:
    """Accepts exactly the anonymized commands of a grammar.

    Raises:
        LanguageError: when made of a grammar with a cycle.
    """

    def __init__(self, grammar: Grammar, root: str = ROOT) -> None:
        self._book = RuleBook(grammar.expander)
        self._root = self._book.number(Nonterminal(root))

    def accepts(self, command: str) -> bool:
        """Whether the grammar derives the command, given as words between spaces."""
        words = tuple(command.split())
        return bool(words) and len(words) in Chart(self._book, words).ends(self._root, 0)
