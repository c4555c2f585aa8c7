"""Find the patterns of the grammar that are nearest to a template whose commands the grammar does not derive."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import SequenceMatcher
from heapq import nlargest

from annotations.language.grammar import Grammar
from annotations.language.suggesting.patterns import PatternMaker
from annotations.language.symbols import Symbols
from annotations.language.templates import SemanticTemplate

# Commands that share the most words are compared in order, and the nearest of them become patterns.
MOST_COMPARED, MOST_GENERALISED = 60, 12


def nearest_patterns(
    command: str,
    commands: Iterable[str],
    grammar: Grammar,
    templates: tuple[SemanticTemplate, ...],
    most: int = 5,
) -> list[tuple[str, Symbols]]:
    """Return up to ``most`` distinct patterns of the grammar, the nearest first, each with a command of it.

    Args:
        command: what the template makes.
        commands: those that the grammar derives; each is looked at once.
        templates: they show which nonterminals patterns are written with.
    """
    words = command.split()
    said = frozenset(words)

    def shared(other: str) -> float:
        others = frozenset(other.split())
        return len(said & others) / len(said | others)

    def likeness(other: str) -> float:
        return SequenceMatcher(None, words, other.split(), False).ratio()

    candidates = nlargest(MOST_COMPARED, commands, key=shared)
    nearest = nlargest(MOST_GENERALISED, candidates, key=likeness)
    maker = PatternMaker(grammar, templates, frozenset())
    patterns: dict[Symbols, str] = {}
    for each in nearest:
        pattern = maker.pattern(each)
        if pattern is not None and len(patterns) < most:
            patterns.setdefault(pattern, each)
    return [(example, pattern) for pattern, example in patterns.items()]
