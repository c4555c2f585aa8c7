"""Automatic checks of a grammar: problems with positions, in file order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import groupby

from annotations.language.forms import Symbols, Text, Wildcard, print_sequence
from annotations.language.grammar.budget import Budget, TooManyCombinations
from annotations.language.grammar.expander import Expander
from annotations.language.grammar.graph import (
    MAX_HEIGHT,
    MAX_WORDS,
    Edges,
    Traversal,
    heights,
    lengths,
    reachable,
)
from annotations.language.grammar.productions import Production
from annotations.language.texts import Position, Problem, error_at, warning_at

# Lines with more expansions than this are not compared: somebody waits for the answer.
COMPARED_EXPANSIONS = 2_000
COMPARED_STEPS = 4_000_000  # for all lines together; the published grammars take 700,000
STEPS_PER_SYMBOL = 4  # the cost of comparing one symbol

Spoken = tuple[Text | Wildcard, ...]


def find_problems(
    productions: tuple[Production, ...],
    rules: Mapping[str, tuple[Symbols, ...]],
    edges: Edges,
    traversal: Traversal,
    root: str,
) -> tuple[Problem, ...]:
    """Return the problems of a grammar whose commands begin at ``root``.

    A missing root, a cycle, nesting beyond ``MAX_HEIGHT`` and commands beyond ``MAX_WORDS`` are
    errors; undefined and unreachable nonterminals are warnings, since real grammars have them.
    """
    problems: list[Problem] = []
    if root not in edges:
        place = place_of(productions, root)
        problems.append(error_at(place, f"the grammar has no ${root}", f"add a line ${root} = …"))
    for cycle in traversal.cycles:
        closing, target = cycle[-2], cycle[-1]
        closing_places = (
            place
            for production in productions
            if production.nonterminal == closing
            for name, place in production.references
            if name == target
        )
        place = next(closing_places, place_of(productions, closing))
        hint = "a command grammar has to be finite: remove one of these references"
        problems.append(error_at(place, f"a cycle: {cycle_text(cycle)}", hint))
    too_large = find_too_large(productions, rules, traversal)
    if too_large is not None:
        problems.append(too_large)
    undefined: dict[str, list[Position]] = {}
    for production in productions:
        for name, place in production.references:
            if name not in edges:
                undefined.setdefault(name, []).append(place)
    for name, places in undefined.items():
        uses = f", used {len(places)} times" if len(places) > 1 else ""
        message = f"nothing defines ${name}{uses}"
        hint = "lines that use it make no commands; define it or remove it"
        problems.append(warning_at(places[0], message, hint))
    if root in edges:
        seen = set(reachable(edges, root))
        for production in productions:
            name = production.nonterminal
            if name not in seen:
                seen.add(name)
                message = f"${root} never reaches ${name}"
                problems.append(warning_at(production.position, message, "use it or remove it"))
    return tuple(problems)


def cycle_text(cycle: tuple[str, ...]) -> str:
    """Return ``$a → $b → $a``; the middle of a long cycle is left out."""
    names = [f"${name}" for name in cycle]
    if len(names) > 12:
        names = [*names[:6], f"… {len(names) - 12} more …", *names[-6:]]
    return " → ".join(names)


def place_of(productions: tuple[Production, ...], name: str) -> Position:
    """Return where ``$name`` is first defined, or the start of the first file if it is undefined."""
    for production in productions:
        if production.nonterminal == name:
            return production.position
    return Position(productions[0].position.source) if productions else Position()


def find_too_large(
    productions: tuple[Production, ...],
    rules: Mapping[str, tuple[Symbols, ...]],
    traversal: Traversal,
) -> Problem | None:
    """Return the problem of a nonterminal that nests too deep or has too many words; None for a cycle."""
    if traversal.cycles:
        return None
    depths = heights(rules, traversal.order)
    deepest = max(depths, key=lambda name: depths[name], default="")
    if deepest and depths[deepest] > MAX_HEIGHT:
        return error_at(
            place_of(productions, deepest),
            f"nonterminals and choices nest {depths[deepest]} deep below ${deepest}",
            f"{MAX_HEIGHT} is the limit",
        )
    for name, words in lengths(rules, traversal.order).items():  # from the leaves up
        if words > MAX_WORDS:
            return error_at(
                place_of(productions, name),
                f"${name} becomes up to {words:,} words",
                f"{MAX_WORDS} is the limit; use fewer nonterminals next to each other",
            )
    return None


def repetitions(
    productions: tuple[Production, ...], alternatives: Callable[[str], tuple[Symbols, ...]]
) -> Iterator[Problem]:
    """Yield a warning at each line that repeats an expansion of an earlier line of its nonterminal.

    It cannot be decided in general whether a context-free grammar is ambiguous. But this one is finite,
    and this is the ambiguity that people write: one expansion with two derivations.

    Wildcards count as they are written, with id and constraint; notes for the referee do not count.
    The grammar has to be finite. Lines for which ``COMPARED_STEPS`` are not enough are not
    compared.
    """
    expander, budget = Expander(alternatives, _keep_spoken), Budget(COMPARED_STEPS)
    by_name = sorted(productions, key=lambda each: each.nonterminal)  # stable: in file order
    for _, lines in groupby(by_name, key=lambda each: each.nonterminal):
        earlier: dict[Spoken, tuple[int, Production]] = {}  # with its number in order of appearance
        for line in lines:
            if expander.size(line.expansion) > COMPARED_EXPANSIONS:
                continue
            try:
                spoken: dict[Spoken, None] = {}  # the distinct expansions of the line, in order
                for items, _ in expander.stream(line.expansion, budget):
                    budget.spend(STEPS_PER_SYMBOL * len(items))
                    spoken[items] = None
            except TooManyCombinations:
                yield warning_at(
                    line.position,
                    "too many combinations to look for repeated lines from here on",
                    "ignore this if no line repeats another",
                )
                return
            repeated = [items for items in spoken if items in earlier]
            example = min(repeated, key=lambda items: earlier[items][0], default=())
            if repeated and (first := earlier[example][1]).expansion != line.expansion:
                verb = "repeats" if len(repeated) == 1 else "repeat"
                example_text = f'"{print_sequence(example)}"' if example else "saying nothing"
                yield warning_at(
                    line.position,
                    f"ambiguous: {len(repeated)} of {len(spoken)} expansions {verb} "
                    f"{first.position}, such as {example_text}",
                    f"remove it from one of the two lines of ${line.nonterminal}",
                )
            for items in spoken:
                earlier.setdefault(items, (len(earlier), line))


def _keep_spoken(symbol: Text | Wildcard) -> Spoken:
    return () if isinstance(symbol, Wildcard) and symbol.kind == "void" else (symbol,)
