"""Normalise the texts that a world has stored, as whatever comes in is normalised."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import copy
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

from django.db import models, transaction

from annotations.exchange.archive_tables import ArchiveTable, tables
from annotations.exchange.row_texts import equal_row, normalise_columns
from annotations.generation.up_to_date import bring_up_to_date
from annotations.generation.world_problems import check_again
from annotations.language.texts import Position, Problem, Refusal, normalise_record, warning_at
from annotations.models import Command, Editable, LogicalForm, StoredProblem, World
from annotations.rows.history import NORMALISED, keep_change
from annotations.rows.stored_problems import as_json
from annotations.rows.synchronise import batches

MADE = (Command, LogicalForm, StoredProblem)  # from other rows, again


@dataclass(frozen=True, slots=True)
class NormalisedWorld:
    """``rows`` counts those that were changed, by table, and the description.

    ``problems`` are those that stay as they are, and why.
    """

    world: str
    is_dry_run: bool
    rows: Mapping[str, int] = field(default_factory=dict)
    problems: tuple[Problem, ...] = ()

    def as_json(self) -> dict[str, Any]:
        return {
            "world": self.world,
            "is_dry_run": self.is_dry_run,
            "rows": dict(self.rows),
            "problems": [as_json(problem) for problem in self.problems],
        }


def normalise_world(world: World, is_dry_run: bool = False) -> NormalisedWorld:
    """Normalise the texts of all rows of ``world`` but those of its frozen splits; all in one transaction.

    What people edit gets a next version, by nobody. A row stays as it is where another one says the same
    already, or nothing would show of it. Commands are generated anew where that takes no worker.

    Args:
        is_dry_run: whether everything is taken back at the end.
    """
    counts: dict[str, int] = {}
    problems: list[Problem] = []
    changed: set[type[models.Model]] = set()
    makes_commands = False
    with transaction.atomic():
        world = World.objects.hold().get(pk=world.pk)
        description = normalise_record(world.description)
        if description != world.description:
            World.objects.filter(pk=world.pk).update(description=description)
            counts["description"] = 1
        for table in tables():
            if table.keeps_texts or table.model in MADE:
                continue
            held = table.model._default_manager.select_for_update()
            odd = list(_odd_rows(table, world))
            for row in chain.from_iterable(
                held.filter(pk__in=keys).order_by("pk") for keys in batches(odd)
            ):
                makes_commands |= isinstance(row, Editable) and row.makes_commands
                problem = _normalise(table, row)
                if problem is None:
                    counts[table.name] = counts.get(table.name, 0) + 1
                    changed.add(table.model)
                else:
                    problems.append(problem)
        for model in changed:
            if issubclass(model, Editable):
                check_again(world, model)
        if changed and makes_commands:
            world.mark_changed()
            outcome = bring_up_to_date(world)
            if not outcome.is_up_to_date:
                sentence = f"the commands are not up to date {outcome.trouble}".strip()
                problems.append(warning_at(Position("commands"), sentence, "generate them"))
        transaction.set_rollback(is_dry_run)
    return NormalisedWorld(world.name, is_dry_run, counts, tuple(problems))


def _odd_rows(table: ArchiveTable, world: World) -> Iterator[int]:
    """Yield the keys of the rows that normalising changes, or would if it could."""
    for row in table.rows_of(world).order_by("pk").iterator():
        written = _columns(table, row)
        try:
            if normalise_columns(table, written)[0] == written:
                continue
        except ValueError:
            pass
        yield row.pk


def _columns(table: ArchiveTable, row: models.Model) -> dict[str, Any]:
    return {each.name: getattr(row, each.attname) for each in table.columns}


def _normalise(table: ArchiveTable, row: models.Model) -> Problem | None:
    """Store the row with its texts normalised. Return why it stays as it is instead."""
    before = copy(row)
    noun = row._meta.verbose_name
    try:
        values, _ = normalise_columns(table, _columns(table, row))
    except Refusal as error:
        return warning_at(Position(table.name), f"{noun} {row.pk} stays as it is: {error}")
    for name, value in values.items():
        setattr(row, name, value)
    if other := equal_row(row):
        sentence = (
            f"{noun} {row.pk} stays as it is: {noun} {other.pk} says “{str(other)[:60]}” already"
        )
        return warning_at(Position(table.name), sentence, "delete one of the two, or change it")
    if isinstance(row, Editable) and isinstance(before, Editable):
        row.version += 1
        row.save()
        keep_change(before, row, reason=NORMALISED)
    else:
        row.save()
    return None
