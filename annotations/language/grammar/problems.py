"""Automatic checks of a grammar: problems with positions, in file order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from annotations.language.errors import Position, Problem, error_at, warning_at
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
from annotations.language.symbols import Symbols


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
    too_large = find_too_large(productions, rules, traversal)
    return (
        *_missing_root(productions, edges, root),
        *(_cycle(productions, cycle) for cycle in traversal.cycles),
        *((too_large,) if too_large is not None else ()),
        *_undefined_nonterminals(productions, edges),
        *_unreachable_nonterminals(productions, edges, root),
    )


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


def _missing_root(
    productions: tuple[Production, ...], edges: Edges, root: str
) -> Iterator[Problem]:
    if root not in edges:
        place = place_of(productions, root)
        yield error_at(place, f"the grammar has no ${root}", f"add a line ${root} = …")


def _cycle(productions: tuple[Production, ...], cycle: tuple[str, ...]) -> Problem:
    closing, target = cycle[-2], cycle[-1]
    places = (
        place
        for production in productions
        if production.nonterminal == closing
        for name, place in production.references
        if name == target
    )
    return error_at(
        next(places, place_of(productions, closing)),
        f"a cycle: {cycle_text(cycle)}",
        "a command grammar has to be finite: remove one of these references",
    )


def find_too_large(
    productions: tuple[Production, ...],
    rules: Mapping[str, tuple[Symbols, ...]],
    traversal: Traversal,
) -> Problem | None:
    """Return the problem of a nonterminal that nests too deep or has too many words; None for a cycle."""
    if traversal.cycles:
        return None
    return _too_high(productions, heights(rules, traversal.order)) or _too_long(
        productions, lengths(rules, traversal.order)
    )


def _too_high(productions: tuple[Production, ...], heights: Mapping[str, int]) -> Problem | None:
    """Return a problem at the nonterminal that nests deepest, if it exceeds ``MAX_HEIGHT``."""
    name = max(heights, key=lambda each: heights[each], default="")
    if not name or heights[name] <= MAX_HEIGHT:
        return None
    return error_at(
        place_of(productions, name),
        f"nonterminals and choices nest {heights[name]} deep below ${name}",
        f"{MAX_HEIGHT} is the limit",
    )


def _too_long(productions: tuple[Production, ...], lengths: Mapping[str, int]) -> Problem | None:
    """Return a problem at the first nonterminal, from the leaves up, that exceeds ``MAX_WORDS``."""
    for name, words in lengths.items():
        if words > MAX_WORDS:
            return error_at(
                place_of(productions, name),
                f"${name} becomes up to {words:,} words",
                f"{MAX_WORDS} is the limit; use fewer nonterminals next to each other",
            )
    return None


def _undefined_nonterminals(productions: tuple[Production, ...], edges: Edges) -> Iterator[Problem]:
    places: dict[str, list[Position]] = {}
    for production in productions:
        for name, place in production.references:
            if name not in edges:
                places.setdefault(name, []).append(place)
    for name, uses_of_name in places.items():
        uses = f", used {len(uses_of_name)} times" if len(uses_of_name) > 1 else ""
        yield warning_at(
            uses_of_name[0],
            f"nothing defines ${name}{uses}",
            "lines that use it make no commands; define it or remove it",
        )


def _unreachable_nonterminals(
    productions: tuple[Production, ...], edges: Edges, root: str
) -> Iterator[Problem]:
    if root not in edges:
        return
    reached = reachable(edges, root)
    seen = set(reached)
    for production in productions:
        name = production.nonterminal
        if name not in seen:
            seen.add(name)
            message = f"${root} never reaches ${name}"
            yield warning_at(production.position, message, "use it or remove it")
