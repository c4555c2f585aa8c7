"""What the editor is told while somebody types: problems with repairs, slots, the canonical layout."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from hashlib import sha256
from typing import Any

from django.core.cache import cache

from annotations.generation.template_check import CheckedTemplate, check_template
from annotations.language.forms import SlotPlace, to_reading
from annotations.language.grammar import Grammar
from annotations.language.templates import (
    BoundedCache,
    Sides,
    Usage,
    completions,
    correspondences,
    format_form,
    format_pattern,
    usage_of,
    with_repairs,
)
from annotations.language.texts import LanguageError, Offsets, Problem
from annotations.models import TaskCategory, World
from annotations.rows.from_rows import (
    classes_of,
    grammar_of,
    predicates_of,
    ready_templates,
    template_of,
)
from annotations.rows.stored_problems import as_stored

KEPT_SECONDS = 3600
# World, its revision and the identity of a grammar → how its templates say slots. The grammar is kept with it.
_USAGES: BoundedCache[tuple[int, int, int], tuple[Usage, Grammar]] = BoundedCache(12)


def assist(world: World, category: TaskCategory | None, pattern: str, form: str) -> dict[str, Any]:
    """Check a template as ``check_template`` does and say what can be done about it.

    Returns:
        JSON: ``problems`` (``field``, ``line``, ``column``, ``at``, ``severity``, ``message``, ``hint``,
        ``repairs``, the ``declaration`` of a predicate that is missing), ``slots`` that both sides have (places
        by field), the ``formatted`` fields, the ``reading`` and the ``gloss`` of the form. Offsets count UTF-16
        units, as browsers do.
    """
    checked = check_template(world, category, pattern, form)
    sides = Sides(pattern, form)
    slots: list[dict[str, Any]] = []
    problems = checked.problems
    declarations: Mapping[str, Any] = {}
    if checked.checker is not None:
        declarations = _declarations(world, checked)
        usage = partial(_usage, world, checked.checker.grammar)
        problems = with_repairs(problems, sides, checked.checker, usage, classes_of(world))
        slots = [
            {
                "pattern": _places(each.in_pattern, sides.pattern),
                "form": _places(each.in_form, sides.form),
            }
            for each in correspondences(sides.pattern, sides.form, checked.checker.grammar)
        ]
    return {
        "problems": [
            {
                **shown_problem(each, sides),
                "declaration": declarations.get(each.undeclared),
            }
            for each in problems
        ],
        "slots": slots,
        "formatted": {"pattern": format_pattern(pattern), "form": format_form(form)},
        "reading": to_reading(checked.template.form) if checked.template else "",
        "gloss": checked.gloss,
    }


def _declarations(world: World, checked: CheckedTemplate) -> dict[str, Any]:
    """Return the predicates that the form uses and nothing declares, by name, as the API takes new ones."""
    names = {each.undeclared for each in checked.problems} - {""}
    if not names or checked.checker is None or checked.template is None:
        return {}
    classes = classes_of(world)
    used = checked.checker.predicates_used(checked.template)
    return {
        name: {
            "name": name,
            "kind": str(predicate.kind),
            "signatures": [
                list(map(str, s.within(classes).arguments)) for s in predicate.signatures
            ],
        }
        for name, predicate in used.items()
        if name in names
    }


def _usage(world: World, grammar: Grammar) -> Usage:
    """Return how the templates that are ready say slots; counted once while they stay as they are."""

    def count() -> tuple[Usage, Grammar]:
        templates = []
        for row in ready_templates(world):
            with suppress(LanguageError):
                templates.append(template_of(row))
        return usage_of(templates, grammar), grammar

    return _USAGES.get((world.pk, world.revision, id(grammar)), count)[0]


def completion_tag(category: TaskCategory) -> str:
    """Return what changes whenever ``completions_of`` may return something else."""
    world = category.grammar.world
    predicates = world.predicates.values_list("name", "kind", "signatures", "gloss")
    known = f"{category.pk} {world.revision} {list(predicates)} {classes_of(world)}"
    return sha256(known.encode()).hexdigest()


def completions_of(category: TaskCategory) -> dict[str, Any]:
    """Return the fields of ``Completions`` as JSON; kept until something changes."""
    world = category.grammar.world
    kept: dict[str, Any] | None = cache.get_or_set(
        f"completions:{completion_tag(category)}",
        lambda: asdict(completions(grammar_of(category), predicates_of(world), classes_of(world))),
        KEPT_SECONDS,
    )
    assert kept is not None
    return kept


def shown_problem(problem: Problem, sides: Sides) -> dict[str, Any]:
    """Return a problem as the editor asks for it: as it is stored, with its offset, its repairs and the
    task category whose productions it is about.
    """
    stored = as_stored(problem)
    text = sides.text(stored["field"])
    at = utf16_index(text, Offsets(text).index(problem.position))
    return {
        **stored,
        "at": at,
        "repairs": [
            {
                "label": repair.label,
                "edits": [
                    {
                        "field": edit.source,
                        "from": utf16_index(sides.text(edit.source), edit.start),
                        "to": utf16_index(sides.text(edit.source), edit.end),
                        "text": edit.text,
                    }
                    for edit in repair.edits
                ],
            }
            for repair in problem.repairs
        ],
        "task_category": problem.task_category,
    }


def _places(places: Iterable[SlotPlace], text: str) -> list[list[int]]:
    return [[utf16_index(text, place.start), utf16_index(text, place.end)] for place in places]


def utf16_index(text: str, index: int) -> int:
    """Return the index in UTF-16 units of the character at ``index``."""
    return len(text[:index].encode("utf-16-le", "surrogatepass")) // 2
