"""Check the templates of task categories together: duplicates and conflicts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from annotations.language.english import say_count
from annotations.language.errors import Problem, error_at, warning_at
from annotations.language.grammar import CHECK_STEPS, Budget
from annotations.language.predicates import Predicate
from annotations.language.symbols import Symbols
from annotations.language.templates.expansion import Conflict, Generated, TaskCategory
from annotations.language.templates.problems import template_checker
from annotations.language.templates.templates import SemanticTemplate

# For all templates of a world together. A hundred published templates take 50,000.
SET_STEPS = 50_000_000


def set_problems(
    categories: Sequence[TaskCategory],
    generated: Generated,
    predicates: Mapping[str, Predicate] | None = None,
) -> tuple[Problem, ...]:
    """Return every problem of the templates, in the order of their places.

    Args:
        generated: what ``generate`` made of the same categories.

    A template that several categories use is checked against the grammar of the first.
    """
    problems: dict[Problem, None] = {}
    spent = 0
    checked: set[tuple[object, SemanticTemplate]] = set()
    for category in categories:
        checker = template_checker(category.grammar, predicates, category.name)
        for template in category.templates:
            if (template.position, template) in checked:
                continue
            checked.add((template.position, template))
            budget = Budget(CHECK_STEPS)
            problems.update(dict.fromkeys(checker.problems(template, budget)))
            spent += budget.spent
            if spent > SET_STEPS:
                return (*sorted(problems), _give_up(template))
        problems.update((problem, None) for _, problem in shared_problems(category, generated))
    return tuple(sorted(problems))


def shared_problems(category: TaskCategory, generated: Generated) -> Iterator[tuple[int, Problem]]:
    """Yield (template index, problem) of what a template has with others: duplicates and conflicts."""
    yield from _duplicates(category)
    yield from _conflicts(category, generated)


def _give_up(template: SemanticTemplate) -> Problem:
    return error_at(
        template.position,
        "too many combinations to check; the templates from here on are not checked",
        "narrow the patterns above",
    )


def _duplicates(category: TaskCategory) -> Iterator[tuple[int, Problem]]:
    first: dict[tuple[Symbols, str], SemanticTemplate] = {}
    for index, template in enumerate(category.templates):
        key = (template.pattern, template.form_text)
        earlier = first.setdefault(key, template)
        if earlier is not template:
            yield (
                index,
                warning_at(
                    template.position,
                    f"duplicate of {earlier.position}",
                    "remove one of the two",
                ),
            )


def _conflicts(category: TaskCategory, generated: Generated) -> Iterator[tuple[int, Problem]]:
    """Yield one problem for each pair of templates that disagree, with a command as an example.

    It stands at the later template, which wins.
    """
    pairs: dict[tuple[int, int], list[Conflict]] = {}
    for conflict in generated.conflicts:
        if conflict.task_category == category.name:
            *losing, (winner, _) = conflict.candidates
            for loser, _ in losing:
                pairs.setdefault((loser, winner), []).append(conflict)
    for (loser, winner), conflicts in pairs.items():
        commands = say_count(len(conflicts), "command")
        yield (
            winner,
            warning_at(
                category.templates[winner].position,
                f'{commands} such as "{conflicts[0].command}" with a different form '
                f"at {category.templates[loser].position}",
                "the later form is kept; correct the one that is wrong",
            ),
        )
