"""Writes what was generated: commands, forms, the problems of both and the coverage of the grammar."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Self, TypeAlias

from annotations import models
from annotations.background.progress import UNWATCHED, Progress
from annotations.generation.coverage import count_coverage, store_coverage
from annotations.generation.generated_rows import CommandRows
from annotations.generation.template_problems import store_template_problems
from annotations.language.errors import Problem, warning_at
from annotations.language.forms import depth, head_predicate, read_form
from annotations.language.templates import Expansion, Generated, Kept, SemanticTemplate
from annotations.models.description import Subject
from annotations.rows.from_rows import AnnotatedCategory
from annotations.rows.problems import store_problems
from annotations.rows.synchronise import Changes, synchronise

# What changes whenever templates or commands do: revision and generations of a world.
Counters: TypeAlias = "tuple[int, int]"

# Canonical form → head predicate and depth.
_MEASURED: Kept[str, tuple[str, int]] = Kept(20_000)


def counters_of(world: models.World) -> Counters:
    """Return what changes whenever templates or commands of ``world`` do."""
    return world.revision, world.generations


class GeneratedWorld:
    """What has to be done so that a world holds what was generated.

    Entering it reads and collects; only ``write``, inside a transaction, writes.
    """

    def __init__(
        self,
        world: models.World,
        categories: Sequence[AnnotatedCategory],
        generated: Generated,
        progress: Progress = UNWATCHED,
    ) -> None:
        self._world = world
        self._categories = categories
        self._generated = generated
        rows = {category.value.name: category.template_rows for category in categories}
        self.commands = CommandRows(world, generated.expansions, rows, progress)

    def __enter__(self) -> Self:
        self.commands.__enter__()
        values = [category.value for category in self._categories]
        commands = frozenset(each.command for each in self._generated.expansions)
        self._forms = _form_rows(self._world, self._generated)
        self._coverage = count_coverage(values, commands)
        return self

    def __exit__(self, *raised: Any) -> None:
        self.commands.__exit__(*raised)

    def write(self, counters: Counters) -> Changes:
        """Write the differences; ``counters`` are the world's as it was generated from, and locked since."""
        changes = _store_forms(self._world, self._forms) + self.commands.apply()
        changes += _remove_unused_forms(self._world)
        problems = [*self._conflicts(), *self._left_out()]
        store_problems(self._world, Subject.COMMANDS, problems)
        store_template_problems(self._world, self._categories, self._generated)
        store_coverage(self._world, self._coverage)
        revision, generations = counters
        models.World.objects.filter(pk=self._world.pk).update(
            generated_revision=revision, generations=generations + 1
        )
        return changes

    def _conflicts(self) -> Iterator[Problem]:
        templates = self._templates()
        for conflict in self._generated.conflicts:
            *losing, (winner, kept) = conflict.candidates
            for loser, form in losing:
                of_set = templates[conflict.task_category]
                yield warning_at(
                    of_set[winner].position,
                    f'"{conflict.command}" gets {kept} here and {form} at {of_set[loser].position}',
                    "the later form is kept; correct the one that is wrong",
                )

    def _left_out(self) -> Iterator[Problem]:
        """Yield what is left out; a template that several categories use is mentioned once."""
        templates = self._templates()
        problems: dict[Problem, None] = {}
        for each in self._generated.left_out:
            place = templates[each.task_category][each.template_index].position
            problems[warning_at(place, each.problem.message, each.problem.hint)] = None
        yield from problems

    def _templates(self) -> Mapping[str, Sequence[SemanticTemplate]]:
        return {category.value.name: category.value.templates for category in self._categories}


def _form_rows(world: models.World, generated: Generated) -> list[models.LogicalForm]:
    """Return the distinct forms, in order of their first command."""
    first: dict[str, Expansion] = {}
    for expansion in generated.expansions:
        first.setdefault(expansion.form_text, expansion)
    return [_form_row(world, text, each.task_category) for text, each in first.items()]


def _form_row(world: models.World, text: str, task_category: str) -> models.LogicalForm:
    head, height = _MEASURED.get(text, lambda: _measure(text))
    return models.LogicalForm(
        world=world,
        text=text,
        head_predicate=head,
        depth=height,
        length=len(text.split()),
        task_category=task_category,
    )


def _measure(text: str) -> tuple[str, int]:
    form = read_form(text)
    return head_predicate(form), depth(form)


def _store_forms(world: models.World, forms: list[models.LogicalForm]) -> Changes:
    """Store the distinct forms; those from before stay while commands have them."""
    fields = ["head_predicate", "depth", "length", "task_category"]
    return synchronise(
        world.logical_forms.all(), forms, lambda row: row.text, fields, is_kept=lambda row: True
    )


def _remove_unused_forms(world: models.World) -> Changes:
    unused = world.logical_forms.filter(commands__isnull=True)
    removed = unused.count()
    if removed:
        unused.delete()
    return Changes(removed=removed)
