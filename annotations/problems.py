"""Problems that a check found, as rows beside what they are about and as commands print them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from annotations import models
from annotations.language.errors import Problem
from annotations.models.problems import Subject
from annotations.rows import Changes, synchronise


def as_json(problem: Problem) -> dict[str, Any]:
    """A problem as commands print it: file, line, column, severity, message, hint."""
    place = problem.position
    return {
        "file": place.source,
        "line": place.line,
        "column": place.column,
        "severity": str(problem.severity),
        "message": problem.message,
        "hint": problem.hint,
    }


def store_problems(world: models.World, subject: Subject, problems: Sequence[Problem]) -> Changes:
    """Makes the stored problems about one part of a world these."""
    wanted = [
        models.StoredProblem(
            world=world,
            subject=subject,
            source=problem.position.source,
            line=problem.position.line,
            column=problem.position.column,
            severity=problem.severity,
            message=problem.message,
            hint=problem.hint,
        )
        for problem in problems
    ]
    return synchronise(world.problems.filter(subject=subject), wanted, _text_of, [])


def _text_of(row: models.StoredProblem) -> tuple[object, ...]:
    return (row.source, row.line, row.column, row.severity, row.message, row.hint)
