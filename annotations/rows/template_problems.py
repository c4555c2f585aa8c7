"""What the checker says of a template, stored in its row so that lists can show and filter it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

from annotations.language.errors import Position, Problem, Severity
from annotations.models import Grammar

StoredRemark = dict[str, Any]


def as_stored(problem: Problem) -> StoredRemark:
    """Return a problem as the row of a template holds it, and as the editor asks for it."""
    return {
        "field": "form" if problem.position.source == "form" else "pattern",
        "line": problem.position.line,
        "column": problem.position.column,
        "severity": str(problem.severity),
        "message": problem.message,
        "hint": problem.hint,
    }


def from_stored(remark: StoredRemark) -> Problem:
    """Return the problem that ``as_stored`` was given."""
    position = Position(remark["field"], remark["line"], remark["column"])
    return Problem(position, Severity(remark["severity"]), remark["message"], remark["hint"])


STORED_TYPES = {
    "field": str,
    "line": int,
    "column": int,
    "severity": str,
    "message": str,
    "hint": str,
}


def is_stored_problems(value: Any) -> bool:
    """Return whether ``value`` is a list of what ``as_stored`` returns."""
    return isinstance(value, list) and all(
        isinstance(each, dict) and {name: type(part) for name, part in each.items()} == STORED_TYPES
        for each in value
    )


def store_problems_of_import(grammar: Grammar, problems: Iterable[Problem]) -> None:
    """Write ``problems``, whose positions are lines of files, into the rows of those lines.

    A template that a person has changed since keeps what was said of their version.
    """
    by_line = defaultdict(list)
    for problem in problems:
        by_line[problem.position.source, problem.position.line].append(as_stored(problem))
    changed = []
    for row in grammar.templates.filter(author=None).exclude(imported_text=""):
        remarks = by_line.get((row.source, row.line), [])
        if row.problems != remarks:
            row.problems = remarks
            changed.append(row)
    grammar.templates.bulk_update(changed, ["problems"], batch_size=500)
