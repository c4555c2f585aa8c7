"""Draw some derivations of each template, spread over the lines that its nonterminals have."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from random import Random

from annotations.language.grammar import TooManyCombinations
from annotations.language.templates.expansion import TaskCategory
from annotations.language.templates.ranked_templates import LineCounts, RankedGrammar
from annotations.language.templates.synchronous import Derivation
from annotations.language.texts import LanguageError


def spread_derivations(
    category: TaskCategory, of_a_template: int, random: Random
) -> Iterator[Derivation]:
    """Yield up to so many derivations of each template, with their wildcards intact, each only once.

    A template whose derivations cannot be counted has none. Raises LanguageError where the grammar has a cycle.
    """
    grammar = RankedGrammar(category.grammar, category.lines)
    used: LineCounts = Counter()
    for index, template in enumerate(category.templates):
        if template.nonterminal:
            continue
        drawn: dict[Derivation, None] = {}
        try:
            ranked = grammar.template(template)
            for _ in range(min(of_a_template, ranked.size)):
                derivation = (
                    ranked.derivation_by_lines(random, used)
                    if ranked.has_lines
                    else ranked.derivation(random.randrange(ranked.size))
                )
                drawn |= dict.fromkeys(ranked.intact(derivation, index)[:1])
        except (LanguageError, TooManyCombinations):
            continue
        yield from drawn
