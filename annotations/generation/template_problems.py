"""The problems that stand in the rows of templates, after others, the grammar or predicates have changed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from annotations import models
from annotations.generation.kept_expansions import checker_of, problems_of
from annotations.language.forms import EntityClasses
from annotations.language.grammar import CHECK_STEPS, Budget
from annotations.language.templates import (
    Generated,
    TemplateChecker,
    read_known_sides,
    shared_problems,
)
from annotations.language.texts import LanguageError
from annotations.models.description import TemplateStatus
from annotations.rows.from_rows import (
    AnnotatedCategory,
    classes_of,
    composition_of,
    grammar_of,
    predicates_of,
)
from annotations.rows.stored_problems import StoredRemark, as_stored

BATCH = 500
MOST_STEPS = 5 * CHECK_STEPS  # for all templates that are not ready: a second of processor time


# What is said of each row.
Remarks: TypeAlias = "Mapping[models.SemanticTemplate, Sequence[StoredRemark]]"


def remarks_on_templates(
    world: models.World,
    categories: Sequence[AnnotatedCategory],
    generated: Generated,
    limit: int | None,
) -> Remarks:
    """Return what the checker says now of each template that is ready, and what it has with others.

    ``limit`` is as in ``TemplateChecker``. It takes seconds of processor time for a large grammar, and writes
    nothing.
    """
    declared, classes = predicates_of(world), classes_of(world)
    remarks: dict[models.SemanticTemplate, list[StoredRemark]] = defaultdict(list)
    for category in categories:
        value = category.value
        try:
            checker = checker_of(value.grammar, declared, value.name, value.lines, limit)
        except LanguageError:
            continue
        for row in category.template_rows:
            if row not in remarks:  # else checked against the grammar of an earlier category
                remarks[row] = _check(row, checker, classes)
        for index, problem in shared_problems(value, generated):
            remark = as_stored(problem)
            of_row = remarks[category.template_rows[index]]
            if remark not in of_row:
                of_row.append(remark)
    return remarks


def store_remarks(remarks: Remarks) -> None:
    """Write remarks. A row of which the same is said keeps those it has, with their places."""
    changed = []
    for row, of_row in remarks.items():
        if _texts_of(row.problems) != _texts_of(of_row):
            row.problems = list(of_row)
            changed.append(row)
    models.SemanticTemplate.objects.bulk_update(changed, ["problems"], batch_size=BATCH)


def check_unready_templates(world: models.World) -> None:
    """Write what the checker says now of the templates that make no commands, such as drafts.

    Beyond ``MOST_STEPS`` the rest keep what was said of them before.
    """
    unready = models.SemanticTemplate.objects.filter(grammar__world=world)
    rows = list(unready.exclude(status=TemplateStatus.READY))
    changed, steps = [], 0
    declared, classes = predicates_of(world), classes_of(world)
    for category in models.TaskCategory.objects.filter(grammar__world=world) if rows else ():
        try:
            checker = checker_of(
                grammar_of(category),
                declared,
                category.name,
                composition_of(category),
                world.most_of_a_template,
            )
        except LanguageError:
            continue
        here = [row for row in rows if row.source in category.template_sources]
        rows = [row for row in rows if row not in here]  # checked against the first grammar only
        for row in here:
            budget = Budget(CHECK_STEPS)
            remarks = _check(row, checker, classes, budget)
            steps += budget.spent
            if steps > MOST_STEPS:
                break
            if row.problems != remarks:
                row.problems = remarks
                changed.append(row)
    models.SemanticTemplate.objects.bulk_update(changed, ["problems"], batch_size=BATCH)


def _check(
    row: models.SemanticTemplate,
    checker: TemplateChecker,
    classes: EntityClasses,
    budget: Budget | None = None,
) -> list[StoredRemark]:
    """Return what ``checker`` says of the row alone."""
    template, unread = read_known_sides(row.pattern, row.form, classes)
    problems = problems_of(checker, template, budget) if template else unread
    return [as_stored(problem) for problem in problems]


def _texts_of(remarks: Iterable[StoredRemark]) -> set[tuple[str, str, str]]:
    return {(each["severity"], each["message"], each["hint"]) for each in remarks}
