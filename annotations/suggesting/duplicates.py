"""Two templates that say the same in one task category, and what can be done about it."""

from __future__ import annotations

from dataclasses import dataclass

from annotations.generation.kept_expansions import expansions_of
from annotations.language.errors import LanguageError
from annotations.models import SemanticTemplate, TaskCategory, World
from annotations.models.description import TemplateStatus
from annotations.rows.from_rows import grammar_of, ready_templates, template_of
from annotations.suggesting.parser_answers import command_for


@dataclass(frozen=True, slots=True)
class Duplicate:
    """``other`` says the same as a template; ``moves`` are the task categories where that would be alone."""

    other: SemanticTemplate
    moves: tuple[TaskCategory, ...]


def duplicate_of(world: World, row: SemanticTemplate) -> Duplicate | None:
    """Return the first template that is ready, says the same as ``row`` and shares a task category with it."""
    if row.status != TemplateStatus.READY:
        return None
    same = _same(world, row)
    categories = TaskCategory.objects.filter(grammar=row.grammar_id)
    together = [each for each in categories if row.source in each.template_sources]
    for other in same:
        if any(other.source in category.template_sources for category in together):
            taken = {row.source, *(each.source for each in same)}
            moves = (each for each in categories if row.moved_to(each) and _takes(each, row, taken))
            return Duplicate(other, tuple(moves))
    return None


def _same(world: World, row: SemanticTemplate) -> list[SemanticTemplate]:
    """Return the other templates with the same form whose patterns read the same."""
    try:
        pattern = template_of(row).pattern
        others = ready_templates(world).filter(form=row.form).exclude(pk=row.pk)
        return [each for each in others if template_of(each).pattern == pattern]
    except LanguageError:
        return []


def _takes(category: TaskCategory, row: SemanticTemplate, taken: set[str]) -> bool:
    """Return whether the template would be alone there, and make commands of the grammar."""
    if taken & set(category.template_sources):
        return False
    try:
        command = command_for(category, row.pattern)
        return bool(command) and expansions_of(grammar_of(category)).accepts(command)
    except LanguageError:
        return False
