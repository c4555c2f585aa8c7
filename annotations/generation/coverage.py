"""How much of a grammar the templates give a meaning to, and what its commands sound like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from annotations import models
from annotations.generation.kept_expansions import expansions_of
from annotations.language.templates import TaskCategory
from annotations.language.texts import LanguageError
from annotations.rows.from_rows import task_categories

SAMPLES = 6


@dataclass(frozen=True, slots=True)
class Coverage:
    """One task category's grammar. ``size`` is an upper estimate of its anonymized commands.

    Where the grammar is small enough, ``commands`` counts the distinct ones, ``covered`` those that
    templates have made a form for; else, and where the world has a sample, both are None.
    ``trouble`` says why it has no size.
    """

    task_category: str
    productions: int
    templates: int
    size: int = 0
    commands: int | None = None
    covered: int | None = None
    samples: tuple[str, ...] = ()
    trouble: str = ""

    @property
    def percent(self) -> float | None:
        return 100 * (self.covered or 0) / self.commands if self.commands else None

    @property
    def n_uncovered(self) -> int | None:
        return None if self.commands is None else self.commands - (self.covered or 0)


def coverage_of(world: models.World) -> list[Coverage]:
    """Return one entry for each task category, in order. Raises LanguageError where a row cannot be read."""
    known = known_commands(world)
    return [_coverage(category, known) for category in task_categories(world)]


def known_commands(world: models.World | None) -> frozenset[str] | None:
    """Return the commands that have a form; None where they are a sample, so that others may have one too."""
    if world is None:
        return frozenset()
    if world.sample_note:
        return None
    return frozenset(world.commands.values_list("anonymized_text", flat=True))


def count_coverage(
    categories: Sequence[TaskCategory], commands: frozenset[str] | None
) -> dict[str, Coverage]:
    """Count by task category how many commands of its grammar are among ``commands``, which have a form.

    Without ``commands`` nothing is counted. Enumerates the grammar, so this belongs to imports and generation,
    never to a page.
    """
    return {category.name: _coverage(category, commands) for category in categories}


def store_coverage(world: models.World, counted: Mapping[str, Coverage]) -> None:
    """Keep the counts beside the task categories, for pages that only read."""
    for category in models.TaskCategory.objects.filter(grammar__world=world):
        each = counted.get(category.name)
        category.commands_in_grammar = each.commands if each else None
        category.commands_with_form = each.covered if each else None
        category.save(update_fields=["commands_in_grammar", "commands_with_form"])


def _coverage(category: TaskCategory, known: frozenset[str] | None) -> Coverage:
    grammar = category.grammar
    counts = len(grammar.productions), len(category.templates)
    try:
        size, commands = grammar.size(), expansions_of(grammar).commands
    except LanguageError as error:
        return Coverage(category.name, *counts, trouble=str(error))
    if commands is None:
        return Coverage(category.name, *counts, size)
    if known is None:
        return Coverage(category.name, *counts, size, samples=spread(commands, SAMPLES))
    covered = sum(command in known for command in commands)
    return Coverage(
        category.name,
        *counts,
        size=size,
        commands=len(commands),
        covered=covered,
        samples=spread(commands, SAMPLES),
    )


def spread(items: Sequence[str], count: int) -> tuple[str, ...]:
    """Return ``count`` of the items, evenly from the first on; all of them where there are no more."""
    if len(items) <= count:
        return tuple(items)
    return tuple(items[index * len(items) // count] for index in range(count))
