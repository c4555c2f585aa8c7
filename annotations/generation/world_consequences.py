"""What a change of templates or productions would do to the commands of a world, before it is saved."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from annotations import models
from annotations.generation.kept_expansions import generate_at_once
from annotations.generation.stale import StaleSplits, stale_splits
from annotations.language.templates import Consequences, GeneratedState, consequences_of
from annotations.language.texts import LanguageError, say_count
from annotations.models.description import TemplateStatus
from annotations.rows.from_rows import Lines, annotated_categories, ready_templates

NEW = 0  # in the place of the key that a new template has not got yet


@dataclass(frozen=True)
class TemplateChange:
    """A template as it would be saved. ``row`` is the stored one, None where it is new.

    ``after`` is unsaved, and None where the template is to be deleted.
    """

    row: models.SemanticTemplate | None
    after: models.SemanticTemplate | None

    def apply(self, ready: Sequence[models.SemanticTemplate]) -> list[models.SemanticTemplate]:
        """Return the templates that are ready after the change, in order."""
        rows = [each for each in ready if self.row is None or each.pk != self.row.pk]
        if self.after is not None and self.after.status == TemplateStatus.READY:
            self.after.pk = self.row.pk if self.row else NEW
            self.after.position = self.row.position if self.row else len(rows)
            if self.row is None:
                return [*rows, self.after]
            rows.append(self.after)
        return sorted(rows, key=lambda each: each.position)


@dataclass(frozen=True)
class WorldConsequences:
    """What a change does to a world. ``trouble`` says why that is not known; all is empty then.

    ``templates`` are the rows that ``changes`` names by their keys.
    """

    changes: Consequences = field(default_factory=Consequences)
    splits: StaleSplits = field(default_factory=StaleSplits)
    templates: dict[int, models.SemanticTemplate] = field(default_factory=dict)
    trouble: str = ""

    @property
    def sentence(self) -> str:
        """Count everything that is different, in one sentence; it says so where nothing is."""
        changes = self.changes
        counts = [
            (changes.covered_in_grammar, "command", "newly covered"),
            (changes.covered_outside, "new command", "outside the grammar"),
            (changes.changed, "command", "with another form"),
            (changes.lost, "command", "without a form from then on"),
            (changes.conflicts, "new conflict", ""),
            (changes.conflicts_gone, "conflict", "resolved"),
            (changes.duplicates, "duplicate", ""),
            (changes.shadowed, "template", "overridden by another"),
            (changes.left_out, "template", "left out"),
            (self.splits.splits, "split", "out of date"),
        ]
        parts = [
            f"{say_count(len(each), noun)} {rest}".strip() for each, noun, rest in counts if each
        ]
        return f"{', '.join(parts)}." if parts else "No command changes."


def consequences(world: models.World, change: TemplateChange) -> WorldConsequences:
    """Return what ``change`` would do to the commands, templates and splits of ``world``. Writes nothing."""
    ready = list(ready_templates(world))
    changed = change.apply(ready)
    try:
        before, after = _state(world, ready), _state(world, changed)
    except LanguageError as error:
        return WorldConsequences(trouble=error.message)
    return _difference(world, before, after, (*ready, *changed))


def consequences_of_lines(world: models.World, lines: Lines) -> WorldConsequences:
    """Return what having ``lines`` in place of its productions would do to ``world``. Writes nothing."""
    ready = list(ready_templates(world))
    try:
        before, after = _state(world, ready), _state(world, ready, lines)
    except LanguageError as error:
        return WorldConsequences(trouble=error.message)
    return _difference(world, before, after, ready)


def _difference(
    world: models.World,
    before: GeneratedState,
    after: GeneratedState,
    rows: Iterable[models.SemanticTemplate],
) -> WorldConsequences:
    changes = consequences_of(before, after)
    splits = stale_splits(world, forms_before(changes))
    return WorldConsequences(changes, splits, {row.pk: row for row in rows})


def forms_before(changes: Consequences) -> dict[str, str]:
    """Return the commands that lose their form or get another one, each with the form that they had."""
    lost = {each.command: each.form_text for each in changes.lost}
    return lost | {each.command: each.before for each in changes.changed}


def _state(
    world: models.World,
    rows: Iterable[models.SemanticTemplate],
    lines: Lines | None = None,
) -> GeneratedState:
    """Raises LanguageError where the world is too large to be generated while somebody waits."""
    categories = annotated_categories(world, rows, lines)
    values = [category.value for category in categories]
    generated = generate_at_once(values)
    names = {
        category.value.name: [row.pk for row in category.template_rows] for category in categories
    }
    return GeneratedState(values, generated, names)
