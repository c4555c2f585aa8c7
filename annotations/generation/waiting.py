"""How many commands wait to be made where templates have made none yet, and what they will cover."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from annotations import models
from annotations.generation.kept_expansions import STEPS_AT_ONCE, expansions_of, generate_at_once
from annotations.generation.language_size import language_size
from annotations.language.grammar import Budget, readable
from annotations.language.templates import DEFAULT_LIMIT
from annotations.language.texts import LanguageError
from annotations.rows.from_rows import task_categories


@dataclass(frozen=True, slots=True)
class WaitingCommands:
    """The commands that ``generate`` would make now.

    ``count`` is exact unless ``is_estimate``, when it is an upper bound. ``coverage`` are the task categories with
    what they will have then; empty where not all of them can be counted.
    """

    count: int
    is_estimate: bool = False
    coverage: Sequence[models.TaskCategory] = ()

    @property
    def said(self) -> str:
        """Write the count as a sentence begins with it, such as ``1,211`` or ``Up to 2.3 million``."""
        return f"Up to {readable(self.count)}" if self.is_estimate else f"{self.count:,}"

    @property
    def is_too_large(self) -> bool:
        """Whether they are so many that only a sample is made."""
        return self.is_estimate and self.count > DEFAULT_LIMIT

    @property
    def in_grammar(self) -> int:
        """How many commands the grammars of all task categories derive, each counted once a category."""
        return sum(each.commands_in_grammar or 0 for each in self.coverage)

    @property
    def with_form(self) -> int:
        """How many of them will have a form."""
        return sum(each.commands_with_form or 0 for each in self.coverage)


def waiting_commands(world: models.World) -> WaitingCommands | None:
    """Count the commands that wait for the first generation; None where there are none, or a row cannot be read.

    A small language is expanded, which takes a moment and is kept for the generation itself; of a large one only the
    size is told. How many commands a grammar derives is what the import has counted.
    """
    if not world.awaits_first_commands:
        return None
    try:
        categories = task_categories(world)
        try:
            commands = frozenset(each.command for each in generate_at_once(categories).expansions)
        except LanguageError:
            return WaitingCommands(language_size(world), is_estimate=True)
        rows = list(models.TaskCategory.objects.filter(grammar__world=world))
        by_name = {row.name: row for row in rows}
        for each in categories:
            derived = expansions_of(each.grammar, each.lines).derived(
                commands, Budget(STEPS_AT_ONCE)
            )
            by_name[each.name].commands_with_form = len(derived)
    except LanguageError:
        return None
    if not commands:
        return None
    is_counted = all(row.commands_in_grammar is not None for row in rows)
    return WaitingCommands(len(commands), coverage=rows if is_counted else ())
