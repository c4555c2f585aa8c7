"""What a task category alone is made of, and why it cannot be deleted."""

from __future__ import annotations

from annotations.language.texts import say_count
from annotations.models import Production, SemanticTemplate, TaskCategory, World
from annotations.rows.composition import rule_files
from annotations.rows.from_rows import grammar_from, lines_of


def require_finite(world: World, category: TaskCategory) -> None:
    """Raise LanguageError where the sets of a category lead back to themselves, or are too large together."""
    grammar_from(category, lines_of(world)).require_finite()


def why_category_is_kept(row: TaskCategory) -> str:
    """Return a sentence that says why the category cannot be deleted; empty where it can."""
    alone = count_alone(row)
    listed = [say_count(number, noun) for noun, number in alone.items() if number]
    if not listed:
        return ""
    return (
        f"{' and '.join(listed)} would belong to no task category. "
        f"Delete them first, or let another task category use the sets of {row.name}."
    )


def count_alone(row: TaskCategory) -> dict[str, int]:
    """Return how many productions and templates no other task category uses, by what they are called."""
    others = TaskCategory.objects.filter(grammar=row.grammar_id).exclude(pk=row.pk)
    rules = {*rule_files([row])} - {*rule_files(others)}
    templates = {*row.template_sources} - {
        each for other in others for each in other.template_sources
    }
    lines = Production.objects.filter(grammar=row.grammar_id, source__in=rules)
    meanings = SemanticTemplate.objects.filter(grammar=row.grammar_id, source__in=templates)
    return {"production": lines.count(), "template": meanings.count()}
