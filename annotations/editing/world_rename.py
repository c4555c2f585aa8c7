"""Verb: rename an entity, a nonterminal or a predicate wherever a world names it, in one transaction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from django.db import models, transaction

from annotations.editing.edits import change_many, hold
from annotations.editing.rename_plans import PLANS
from annotations.generation.template_problems import check_unready_templates
from annotations.language.texts import LanguageError, say_count
from annotations.models import (
    AuditDecision,
    AuditFinding,
    AuditReason,
    CampaignPrompt,
    Command,
    Editable,
    Label,
    LogicalForm,
    User,
    World,
)
from annotations.rows.synchronise import BATCH

MOST_EXAMPLES = 5


@dataclass(frozen=True, slots=True)
class TextChange:
    """A text of a row before and after."""

    before: str
    after: str


@dataclass(frozen=True, slots=True)
class TouchedRows:
    """The rows of one kind, a ``noun``, that a new name changes."""

    noun: str
    changes: tuple[tuple[models.Model, Mapping[str, Any]], ...]

    def __len__(self) -> int:
        return len(self.changes)

    @property
    def sentence(self) -> str:
        return say_count(len(self), self.noun)

    @property
    def examples(self) -> list[TextChange]:
        """The first texts that change, without answers that may be hidden from the reader."""
        shown = [
            change
            for change in self.changes
            if not isinstance(change[0], Label) or change[0].counts
        ]
        return [
            TextChange(before, after)
            for row, values in shown[:MOST_EXAMPLES]
            for name, after in values.items()
            if isinstance(before := getattr(row, name), str) and before != after
        ]


def touched_by(row: Editable, old: str, new: str) -> tuple[TouchedRows, ...]:
    """Return what calling ``row`` ``new`` instead of ``old`` changes, by kind. Writes nothing.

    ``old`` is the text or an alias of an entity, a predicate, or the nonterminal of a production.

    Raises:
        LanguageError: a sentence: the new name is taken, or means something else.
    """
    plan = PLANS[type(row)](row, old)
    plan.require_free(new)
    touched = tuple(
        TouchedRows(noun, tuple(changes)) for noun, changes in plan.changes(new) if changes
    )
    for each in touched:
        for changed, values in each.changes:
            _require_fits(each.noun, changed, values)
    return touched


def _require_fits(noun: str, row: models.Model, values: Mapping[str, Any]) -> None:
    """Raise LanguageError where a text with the new name is longer than its column."""
    for name, value in values.items():
        longest = getattr(row._meta.get_field(name), "max_length", None)
        if isinstance(value, str) and longest and len(value) > longest:
            raise LanguageError(
                f"the {name} of the {noun} “{str(row)[:60]}” would have {len(value):,} characters",
                hint=f"{longest:,} is the limit; choose a shorter name",
            )


def rename(row: Editable, old: str, new: str, by: User, version: int) -> tuple[TouchedRows, ...]:
    """Change every row of ``touched_by``, and bring up to date the commands and what the checker says.

    All of it or nothing.

    Raises:
        Overtaken: ``row`` is not at ``version`` any more.
        LanguageError: as ``touched_by``.
    """
    with transaction.atomic():
        world = World.objects.hold().get(pk=row.owning_world.pk)
        stored = hold(row, version, by)
        touched = touched_by(stored, old, new)
        changes = [change for each in touched for change in each.changes]
        edited = [(each, values) for each, values in changes if isinstance(each, Editable)]
        for each, values in changes:
            if not isinstance(each, Editable):
                for name, value in values.items():
                    setattr(each, name, value)
        for model in COLUMNS:
            rows = [each for each, _ in changes if type(each) is model]
            if rows:
                model._default_manager.bulk_update(rows, COLUMNS[model], batch_size=BATCH)
        change_many(world, edited, by)
        check_unready_templates(world)
        return touched


# Rows that have no version and no history, and their fields that name something.
COLUMNS = {
    Command: ["task_category"],
    LogicalForm: ["task_category"],
    CampaignPrompt: ["task_category"],
    Label: ["form"],
    AuditFinding: ["form", "suggested_form", "decided_form"],
    AuditReason: ["suggested_form"],
    AuditDecision: ["form"],
}
