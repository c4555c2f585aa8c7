"""Verb: make the commands of a world, each with its logical form, from its templates and grammar."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from django.db import transaction

from annotations import models
from annotations.complexity import Complexity, complexity
from annotations.language.errors import Problem, warning
from annotations.language.expansion import DEFAULT_LIMIT, Conflict, Expansion, Generated, generate
from annotations.language.logic import depth, head_predicate, read_form
from annotations.models.problems import Subject
from annotations.problems import store_problems
from annotations.reading import AnnotatedCategory, annotated_categories
from annotations.rows import Changes, synchronise


@dataclass(frozen=True)
class GenerationReport:
    """What a generation gave. ``columns`` are those of the complexity table, all of them last."""

    generated: Generated
    columns: tuple[Complexity, ...]
    categories: tuple[AnnotatedCategory, ...]
    changes: Changes

    def as_json(self) -> dict[str, Any]:
        """Figures by task category; under ``all`` those of all together."""
        names = [column.task_category or "all" for column in self.columns]

        def by_category(figure: str) -> dict[str, Any]:
            values = (getattr(column, figure) for column in self.columns)
            return dict(zip(names, map(_rounded, values), strict=True))

        return {
            "commands": by_category("commands"),
            "forms": by_category("forms"),
            "conflicts": [self._conflict(each) for each in self.generated.conflicts],
            "outside_grammar": len(self.generated.outside_grammar),
            "unmatched_templates": [str(self._place(*each)) for each in self.generated.unmatched],
            "mean_command_length": by_category("mean_command_length"),
            "mean_form_length": by_category("mean_form_length"),
            "commands_per_form": by_category("commands_per_form"),
            "changes": self.changes.as_json(),
        }

    def _conflict(self, conflict: Conflict) -> dict[str, Any]:
        return {
            "task_category": conflict.task_category,
            "command": conflict.command,
            "kept": conflict.kept,
            "candidates": [
                {"template": str(self._place(conflict.task_category, index)), "form": form}
                for index, form in conflict.candidates
            ],
        }

    def _place(self, task_category: str, index: int) -> object:
        return _templates(self.categories)[task_category][index].position


def generate_pairs(world: models.World, limit: int = DEFAULT_LIMIT) -> GenerationReport:
    """Stores the commands and logical forms of ``world`` and says what they are.

    Rows that are right already are not touched; a command that no template makes any more goes,
    and its paraphrases stay. Conflicts are stored as warnings.

    Raises:
        LanguageError: the templates make more than ``limit`` commands (nothing is changed then),
            or a stored text cannot be read.
    """
    categories = annotated_categories(world)
    generated = generate([category.value for category in categories], limit)
    with transaction.atomic():
        models.World.objects.select_for_update().get(pk=world.pk)
        changes = _store_forms(world, generated)
        changes += _store_commands(world, generated, categories)
        changes += _remove_unused_forms(world)
        store_problems(world, Subject.COMMANDS, list(_conflict_problems(generated, categories)))
    return GenerationReport(generated, tuple(complexity(world)), categories, changes)


def _store_forms(world: models.World, generated: Generated) -> Changes:
    """Distinct forms, in order of their first command. Old ones stay while commands have them."""
    first: dict[str, Expansion] = {}
    for expansion in generated.expansions:
        first.setdefault(expansion.form_text, expansion)
    wanted = [_form_row(world, text, each.task_category) for text, each in first.items()]
    fields = ["head_predicate", "depth", "length", "task_category"]
    return synchronise(
        world.logical_forms.all(), wanted, lambda row: row.text, fields, is_kept=lambda row: True
    )


def _remove_unused_forms(world: models.World) -> Changes:
    unused = world.logical_forms.filter(commands__isnull=True)
    removed = unused.count()
    if removed:
        unused.delete()
    return Changes(removed=removed)


def _form_row(world: models.World, text: str, task_category: str) -> models.LogicalForm:
    form = read_form(text)
    return models.LogicalForm(
        world=world,
        text=text,
        head_predicate=head_predicate(form),
        depth=depth(form),
        length=len(text.split()),
        task_category=task_category,
    )


def _store_commands(
    world: models.World, generated: Generated, categories: tuple[AnnotatedCategory, ...]
) -> Changes:
    form_ids = dict(world.logical_forms.values_list("text", "pk"))
    rows = {category.value.name: category.template_rows for category in categories}
    wanted = [
        models.Command(
            world=world,
            template=rows[each.task_category][each.template_index],
            logical_form_id=form_ids[each.form_text],
            anonymized_text=each.command,
            length=len(each.command.split()),
            task_category=each.task_category,
            is_in_grammar=each.in_grammar,
            position=position,
        )
        for position, each in enumerate(generated.expansions)
    ]
    return synchronise(
        world.commands.all(),
        wanted,
        lambda row: row.anonymized_text,
        [
            "template_id",
            "logical_form_id",
            "length",
            "task_category",
            "is_in_grammar",
            "position",
        ],
    )


def _conflict_problems(
    generated: Generated, categories: tuple[AnnotatedCategory, ...]
) -> Iterator[Problem]:
    templates = _templates(categories)
    for conflict in generated.conflicts:
        *losing, (winner, kept) = conflict.candidates
        for loser, form in losing:
            of_set = templates[conflict.task_category]
            yield warning(
                of_set[winner].position,
                f'"{conflict.command}" gets {kept} here and {form} at {of_set[loser].position}',
                "the later form is kept; correct the one that is wrong",
            )


def _templates(categories: tuple[AnnotatedCategory, ...]) -> Mapping[str, Any]:
    return {category.value.name: category.value.templates for category in categories}


def _rounded(value: float | None) -> float | None:
    return round(value, 4) if isinstance(value, float) else value
