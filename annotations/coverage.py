"""How much of a grammar the templates give a meaning to, and what its commands sound like."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from annotations.language.errors import LanguageError
from annotations.language.expansion import TaskCategory
from annotations.models import World
from annotations.reading import task_categories

MOST_ENUMERATED = 50_000  # a larger grammar is answered with its size alone
SAMPLES = 6
MOST_SHOWN = 30


@dataclass(frozen=True, slots=True)
class Coverage:
    """One task category's grammar. ``size`` is an upper estimate of its anonymized commands.

    Where the grammar is small enough, ``commands`` counts the distinct ones, ``covered`` those that
    templates have made a form for; else both are None. ``trouble`` says why it has no size.
    """

    task_category: str
    productions: int
    templates: int
    size: int = 0
    commands: int | None = None
    covered: int | None = None
    samples: tuple[str, ...] = ()
    uncovered: tuple[str, ...] = ()
    trouble: str = ""

    @property
    def percent(self) -> float | None:
        return 100 * self.covered / self.commands if self.commands else None

    @property
    def n_uncovered(self) -> int | None:
        return None if self.commands is None else self.commands - (self.covered or 0)


def coverage_of(world: World) -> list[Coverage]:
    """One entry for each task category, in order. Raises LanguageError where a row cannot be read."""
    known = frozenset(world.commands.values_list("anonymized_text", flat=True))
    return [_coverage(category, known) for category in task_categories(world)]


def _coverage(category: TaskCategory, known: frozenset[str]) -> Coverage:
    grammar = category.grammar
    counts = len(grammar.productions), len(category.templates)
    try:
        size = grammar.size()
        if size > MOST_ENUMERATED:
            return Coverage(category.name, *counts, size)
        commands = list(grammar.commands(limit=MOST_ENUMERATED))
    except LanguageError as error:
        return Coverage(category.name, *counts, trouble=str(error))
    uncovered = [command for command in commands if command not in known]
    return Coverage(
        category.name,
        *counts,
        size=size,
        commands=len(commands),
        covered=len(commands) - len(uncovered),
        samples=spread(commands, SAMPLES),
        uncovered=tuple(uncovered[:MOST_SHOWN]),
    )


def spread(items: Sequence[str], count: int) -> tuple[str, ...]:
    """``count`` of the items, evenly from the first on; all of them where there are no more."""
    if len(items) <= count:
        return tuple(items)
    return tuple(items[index * len(items) // count] for index in range(count))
