"""Problems that a check found, as rows store them (those of a template in its own row) and as commands print them."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import Any

from annotations import models
from annotations.language.texts import Position, Problem, Severity, say_count
from annotations.models import Grammar
from annotations.models.description import ProblemSubject
from annotations.rows.synchronise import Changes, synchronise

# Of one part of an upload. A file of another kind can have a problem in each of 200,000 lines.
MOST_PROBLEMS = 1_000
TEXTS = ("source", "line", "column", "severity", "message", "hint")
StoredRemark = dict[str, Any]


def first_problems(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Return the first ``MOST_PROBLEMS`` by place, errors before warnings, and one that counts the rest.

    The result is in the order of the places, and has an error if ``problems`` has one.
    """
    ranked = sorted(problems, key=lambda each: (not each.is_error, each))
    kept, rest = ranked[:MOST_PROBLEMS], ranked[MOST_PROBLEMS:]
    if rest:
        sentence = f"{say_count(len(rest), 'more problem')} from here on, not listed"
        kept.append(replace(rest[0], message=sentence, hint="correct the listed ones first"))
    return tuple(sorted(kept))


def as_json(problem: Problem) -> dict[str, Any]:
    """Return a problem as commands print it: file, line, column, severity, message, hint."""
    place = problem.position
    return {
        "file": place.source,
        "line": place.line,
        "column": place.column,
        "severity": str(problem.severity),
        "message": problem.message,
        "hint": problem.hint,
    }


def from_json(report: Mapping[str, Any]) -> Problem:
    """Return the problem that ``as_json`` was given."""
    position = Position(report["file"], report["line"], report["column"])
    return Problem(position, Severity(report["severity"]), report["message"], report["hint"])


def store_problems(
    world: models.World, subject: ProblemSubject, problems: Sequence[Problem]
) -> Changes:
    """Replace the stored problems about one part of a world."""
    stored = world.problems.filter(subject=subject)
    texts = [
        (
            each.position.source,
            each.position.line,
            each.position.column,
            each.severity.value,
            each.message,
            each.hint,
        )
        for each in problems
    ]
    if Counter(texts) == Counter(stored.order_by().values_list(*TEXTS)):
        return Changes()
    wanted = [
        models.StoredProblem(world=world, subject=subject, **dict(zip(TEXTS, text, strict=True)))
        for text in texts
    ]
    return synchronise(stored, wanted, attrgetter(*TEXTS), [])


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
