"""The problems that stand in the rows of templates, after others or the grammar have changed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence

from annotations import models
from annotations.editing.template_problems import StoredRemark, as_stored
from annotations.generation.kept_expansions import checker_of, problems_of
from annotations.language.errors import LanguageError
from annotations.language.templates import Generated, read_sides, shared_problems
from annotations.rows.from_rows import AnnotatedCategory, predicates_of

BATCH = 500


def store_template_problems(
    world: models.World, categories: Sequence[AnnotatedCategory], generated: Generated
) -> None:
    """Write what the checker says now of each template that is ready, and what it has with others.

    A row of which the same is said keeps its remarks as they are, with their places.
    """
    changed = []
    for row, remarks in _remarks(world, categories, generated).items():
        if _said(row.problems) != _said(remarks):
            row.problems = remarks
            changed.append(row)
    models.SemanticTemplate.objects.bulk_update(changed, ["problems"], batch_size=BATCH)


def _remarks(
    world: models.World, categories: Sequence[AnnotatedCategory], generated: Generated
) -> dict[models.SemanticTemplate, list[StoredRemark]]:
    declared = predicates_of(world)
    remarks: dict[models.SemanticTemplate, list[StoredRemark]] = defaultdict(list)
    for category in categories:
        value = category.value
        try:
            checker = checker_of(value.grammar, declared, value.name)
        except LanguageError:
            continue
        for row in category.template_rows:
            if row in remarks:  # checked against the grammar of the first category
                continue
            template, unread = read_sides(row.pattern, row.form)
            problems = problems_of(checker, template) if template else unread
            remarks[row] = [as_stored(problem) for problem in problems]
        for index, problem in shared_problems(value, generated):
            remark = as_stored(problem)
            of_row = remarks[category.template_rows[index]]
            if remark not in of_row:
                of_row.append(remark)
    return remarks


def _said(remarks: Iterable[StoredRemark]) -> set[tuple[str, str, str]]:
    return {(each["severity"], each["message"], each["hint"]) for each in remarks}
