"""Write what was generated: commands, forms, the problems of both and the coverage of the grammar.

All is compared with what is there first, then written in one short transaction.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from typing import Any, Self, TypeAlias

from django.db.models import OuterRef, Subquery

from annotations import models
from annotations.background.progress import UNWATCHED, Progress
from annotations.generation.coverage import count_coverage, store_coverage
from annotations.generation.template_problems import remarks_on_templates, store_remarks
from annotations.language.forms import depth, head_predicate, read_form
from annotations.language.templates import (
    DEFAULT_LIMIT,
    BoundedCache,
    Expansion,
    Generated,
    SampleNote,
)
from annotations.language.texts import Problem, warning_at
from annotations.models.description import ProblemSubject
from annotations.rows.from_rows import AnnotatedCategory
from annotations.rows.staging import Staging
from annotations.rows.stored_problems import store_problems
from annotations.rows.synchronise import Changes, batches, synchronise

COLUMNS = ("anonymized_text", "template_id", "length", "task_category", "is_in_grammar", "position")
# Template, form, length, task category, whether the grammar has it, position.
Values = tuple[int | None, str, int, str, bool, int]
STORED = (
    *("pk", "anonymized_text", "template_id", "logical_form__text", "length", "task_category"),
    *("is_in_grammar", "position"),
)
# What changes whenever templates or commands do: revision and generations of a world.
Counters: TypeAlias = "tuple[int, int]"

# Canonical form → head predicate and depth.
_MEASURED: BoundedCache[str, tuple[str, int]] = BoundedCache(20_000)


class CommandRows:
    """What has to be done so that the commands of a world are the generated ones.

    Making one reads and collects; only ``apply``, inside a transaction, writes. ``new_forms`` counts the
    commands that are there already and get another form.
    """

    def __init__(
        self,
        world: models.World,
        expansions: Sequence[Expansion],
        templates: Mapping[str, Sequence[models.SemanticTemplate]],
        progress: Progress,
    ) -> None:
        self._world = world
        self._wanted = {
            expansion.command: (
                templates[expansion.task_category][expansion.template_index].pk,
                expansion.form_text,
                len(expansion.command.split()),
                expansion.task_category,
                expansion.in_grammar,
                position,
            )
            for position, expansion in enumerate(expansions)
        }
        self._progress = progress
        self._stack = ExitStack()
        self._counts = {"added": 0, "changed": 0, "moved": 0}
        self.new_forms = 0
        self._removed: list[int] = []

    def __enter__(self) -> Self:
        self._staging = self._stack.enter_context(Staging(models.Command, COLUMNS, ["form_text"]))
        stored: dict[str, tuple[int, Values]] = {}
        for pk, text, *values in self._world.commands.values_list(*STORED).iterator():
            stored[text] = pk, tuple(values)
        self._removed = [pk for text, (pk, _) in stored.items() if text not in self._wanted]
        self._staging.add(self._differing(stored), self._progress)
        return self

    def __exit__(self, *raised: Any) -> None:
        self._stack.__exit__(*raised)

    def _differing(self, stored: Mapping[str, tuple[int, Values]]) -> Iterator[tuple[Any, ...]]:
        for text, wanted in self._wanted.items():
            pk, values = stored.get(text, (None, None))
            if values == wanted:
                continue
            if values is None:
                self._counts["added"] += 1
            else:
                self._counts["moved" if values[:-1] == wanted[:-1] else "changed"] += 1
                self.new_forms += values[1] != wanted[1]
            template, form, *others = wanted
            yield pk, text, template, *others, form

    def apply(self) -> Changes:
        """Write the differences; the forms must be there by now."""
        for keys in batches(self._removed):
            gone = models.Command.objects.filter(pk__in=keys)
            # Paraphrases of what goes keep its text, so that they find it when it is made again.
            text = gone.filter(pk=OuterRef("command")).values("anonymized_text")
            models.Paraphrase.objects.filter(command__in=gone).update(command_text=Subquery(text))
            gone.delete()
        form = (
            "(SELECT f.id FROM annotations_logicalform f "
            f"WHERE f.world_id = {int(self._world.pk)} AND f.text = s.form_text)"
        )
        self._staging.update(logical_form_id=form)
        self._staging.insert(logical_form_id=form, world_id=str(int(self._world.pk)))
        if self._counts["added"]:
            lost = self._world.paraphrases.filter(command=None).exclude(command_text="").order_by()
            for texts in batches(lost.values_list("command_text", flat=True).distinct()):
                commands = self._world.commands.filter(anonymized_text__in=texts)
                for command in commands.values("pk", "anonymized_text"):
                    same = lost.filter(command_text=command["anonymized_text"])
                    same.update(command=command["pk"], command_text="")
        return Changes(removed=len(self._removed), **self._counts)


def counters_of(world: models.World) -> Counters:
    """Return what changes whenever templates or commands of ``world`` do."""
    return world.revision, world.generations


class GeneratedWorld:
    """What has to be done so that a world holds what was generated.

    Entering it reads and collects; only ``write``, inside a transaction, writes. ``sample`` is remembered
    with the world: what sample the commands are, if any.
    """

    def __init__(
        self,
        world: models.World,
        categories: Sequence[AnnotatedCategory],
        generated: Generated,
        progress: Progress = UNWATCHED,
        sample: SampleNote | None = None,
    ) -> None:
        self._world = world
        self._categories = categories
        self._generated = generated
        self._sample = sample
        self._progress = progress
        rows = {category.value.name: category.template_rows for category in categories}
        self.commands = CommandRows(world, generated.expansions, rows, progress)

    def __enter__(self) -> Self:
        self.commands.__enter__()
        values = [category.value for category in self._categories]
        commands = frozenset(each.command for each in self._generated.expansions)
        first: dict[str, Expansion] = {}
        for expansion in self._generated.expansions:
            first.setdefault(expansion.form_text, expansion)
        self._forms = []
        for text, expansion in first.items():
            head, height = _MEASURED.get(text, partial(_measure, text))
            self._forms.append(
                models.LogicalForm(
                    world=self._world,
                    text=text,
                    head_predicate=head,
                    depth=height,
                    length=len(text.split()),
                    task_category=expansion.task_category,
                )
            )
        # Commands outside a sample are not without a form, so nothing is counted.
        is_sample = self._sample is not None and not self._sample.is_all
        self._coverage = count_coverage(values, None if is_sample else commands)
        self._progress.report(0.7, "checking the templates")
        limit = None if self._sample else DEFAULT_LIMIT
        self._remarks = remarks_on_templates(self._world, self._categories, self._generated, limit)
        return self

    def __exit__(self, *raised: Any) -> None:
        self.commands.__exit__(*raised)

    def write(self, counters: Counters) -> Changes:
        """Write the differences; ``counters`` are the world's as it was generated from, and locked since."""
        changes = synchronise(
            self._world.logical_forms.all(),
            self._forms,
            key=lambda row: row.text,
            fields=["head_predicate", "depth", "length", "task_category"],
            is_kept=lambda row: True,  # while commands have it
        )
        changes += self.commands.apply()
        unused = self._world.logical_forms.filter(commands__isnull=True)
        if removed := unused.count():
            unused.delete()
        changes += Changes(removed=removed)
        store_problems(self._world, ProblemSubject.COMMANDS, list(self._problems()))
        store_remarks(self._remarks)
        store_coverage(self._world, self._coverage)
        revision, generations = counters
        models.World.objects.filter(pk=self._world.pk).update(
            generated_revision=revision,
            generations=generations + 1,
            sample=self._sample.as_json() if self._sample else {},
        )
        return changes

    def _problems(self) -> Iterator[Problem]:
        """Yield conflicts, and what is left out; a template of several categories is mentioned once."""
        values = [category.value for category in self._categories]
        templates = {value.name: value.templates for value in values}
        for conflict in self._generated.conflicts:
            *losing, (winner, kept) = conflict.candidates
            for loser, form in losing:
                of_set = templates[conflict.task_category]
                yield warning_at(
                    of_set[winner].position,
                    f'"{conflict.command}" gets {kept} here and {form} at {of_set[loser].position}',
                    "the later form is kept; correct the one that is wrong",
                )
        problems: dict[Problem, None] = {}
        for each in self._generated.left_out:
            place = templates[each.task_category][each.template_index].position
            problems[warning_at(place, each.problem.message, each.problem.hint)] = None
        yield from problems


def _measure(text: str) -> tuple[str, int]:
    form = read_form(text)
    return head_predicate(form), depth(form)
