"""What can be said against the templates of task categories together: duplicates and conflicts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from annotations.language.errors import Problem, warning
from annotations.language.expansion import Conflict, Generated, TaskCategory
from annotations.language.predicates import Predicate
from annotations.language.symbols import Sequence as Pattern
from annotations.language.template_problems import template_checker
from annotations.language.templates import SemanticTemplate


def set_problems(
    categories: Sequence[TaskCategory],
    generated: Generated,
    predicates: Mapping[str, Predicate] | None = None,
) -> tuple[Problem, ...]:
    """Every problem of the templates, in the order of their places.

    Args:
        generated: what ``generate`` made of the same categories.

    A template that several categories use is checked against the grammar of the first.
    """
    found: dict[Problem, None] = {}
    checked: set[tuple[object, SemanticTemplate]] = set()
    for category in categories:
        checker = template_checker(category.grammar, predicates)
        for template in category.templates:
            if (template.position, template) not in checked:
                checked.add((template.position, template))
                found.update(dict.fromkeys(checker.problems(template)))
        found.update(dict.fromkeys(_duplicates(category)))
        found.update(dict.fromkeys(_conflicts(category, generated)))
    return tuple(sorted(found))


def _duplicates(category: TaskCategory) -> Iterator[Problem]:
    first: dict[tuple[Pattern, str], SemanticTemplate] = {}
    for template in category.templates:
        key = (template.pattern, template.form_text)
        earlier = first.setdefault(key, template)
        if earlier is not template:
            yield warning(
                template.position,
                f"this template stands at {earlier.position} already",
                "remove one of the two",
            )


def _conflicts(category: TaskCategory, generated: Generated) -> Iterator[Problem]:
    """One finding for each pair of templates that disagree, with a command as an example."""
    pairs: dict[tuple[int, int], list[Conflict]] = {}
    for conflict in generated.conflicts:
        if conflict.task_category == category.name:
            *losing, (winner, _) = conflict.candidates
            for loser, _ in losing:
                pairs.setdefault((loser, winner), []).append(conflict)
    for (loser, winner), conflicts in pairs.items():
        commands = f"{len(conflicts)} command{'s' if len(conflicts) > 1 else ''}"
        yield warning(
            category.templates[winner].position,
            f'{commands} such as "{conflicts[0].command}" get another form '
            f"at {category.templates[loser].position}",
            "the later form is kept; correct the one that is wrong",
        )
