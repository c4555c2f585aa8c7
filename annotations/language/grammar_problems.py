"""What can be said against a grammar without a person: positioned findings, in file order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from annotations.language.errors import Position, Problem, error, warning
from annotations.language.grammar_graph import (
    MAX_HEIGHT,
    Edges,
    Traversal,
    heights,
    reachable,
)
from annotations.language.productions import Production
from annotations.language.symbols import Sequence


def find_problems(
    productions: tuple[Production, ...],
    rules: Mapping[str, tuple[Sequence, ...]],
    edges: Edges,
    traversal: Traversal,
    root: str,
) -> tuple[Problem, ...]:
    """The findings about a grammar whose commands begin at ``root``.

    A missing root, a cycle and nesting beyond ``MAX_HEIGHT`` are errors; undefined and unreachable
    nonterminals are warnings, since real grammars have them.
    """
    too_high = find_too_high(productions, rules, traversal)
    return (
        *_missing_root(productions, edges, root),
        *(_cycle(productions, cycle) for cycle in traversal.cycles),
        *((too_high,) if too_high is not None else ()),
        *_undefined(productions, edges),
        *_unreachable(productions, edges, root),
    )


def cycle_text(cycle: tuple[str, ...]) -> str:
    """``$a → $b → $a``; the middle of a long one is left out."""
    names = [f"${name}" for name in cycle]
    if len(names) > 12:
        names = [*names[:6], f"… {len(names) - 12} more …", *names[-6:]]
    return " → ".join(names)


def place_of(productions: tuple[Production, ...], name: str) -> Position:
    """Where ``$name`` is first defined; where it is not, the start of the first file."""
    for production in productions:
        if production.nonterminal == name:
            return production.position
    return Position(productions[0].position.source) if productions else Position()


def _missing_root(
    productions: tuple[Production, ...], edges: Edges, root: str
) -> Iterator[Problem]:
    if root not in edges:
        place = place_of(productions, root)
        yield error(place, f"the grammar has no ${root}", f"add a line ${root} = …")


def _cycle(productions: tuple[Production, ...], cycle: tuple[str, ...]) -> Problem:
    closing, target = cycle[-2], cycle[-1]
    places = (
        place
        for production in productions
        if production.nonterminal == closing
        for name, place in production.references
        if name == target
    )
    return error(
        next(places, place_of(productions, closing)),
        f"a cycle: {cycle_text(cycle)}",
        "a command grammar is finite: take one of these references out",
    )


def find_too_high(
    productions: tuple[Production, ...],
    rules: Mapping[str, tuple[Sequence, ...]],
    traversal: Traversal,
) -> Problem | None:
    """The highest nonterminal where one passes ``MAX_HEIGHT``; nothing to say where there is a cycle."""
    if traversal.cycles:
        return None
    found = heights(rules, traversal.order)
    name = max(found, key=lambda each: found[each], default="")
    if not name or found[name] <= MAX_HEIGHT:
        return None
    return error(
        place_of(productions, name),
        f"nonterminals and choices nest {found[name]} deep below ${name}",
        f"{MAX_HEIGHT} is the limit",
    )


def _undefined(productions: tuple[Production, ...], edges: Edges) -> Iterator[Problem]:
    places: dict[str, list[Position]] = {}
    for production in productions:
        for name, place in production.references:
            if name not in edges:
                places.setdefault(name, []).append(place)
    for name, found in places.items():
        uses = f", used {len(found)} times" if len(found) > 1 else ""
        yield warning(
            found[0],
            f"nothing defines ${name}{uses}",
            "what reaches it yields no command; define it or take it out",
        )


def _unreachable(productions: tuple[Production, ...], edges: Edges, root: str) -> Iterator[Problem]:
    if root not in edges:
        return
    found = reachable(edges, root)
    seen = set(found)
    for production in productions:
        name = production.nonterminal
        if name not in seen:
            seen.add(name)
            message = f"${root} never reaches ${name}"
            yield warning(production.position, message, "use it or take it out")
