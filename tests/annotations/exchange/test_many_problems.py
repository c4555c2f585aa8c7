"""A file that is wrong in every line is told in part."""

from __future__ import annotations

from annotations.exchange.generator_import import import_generator
from annotations.language.texts.errors import Position, error_at
from annotations.models import StoredProblem
from annotations.rows.stored_problems import MOST_PROBLEMS, first_problems

WARNED = "".join(f"$Main = go {number}\n$lost{number} = x\n" for number in range(1_500))


def test_the_first_warnings_are_stored_and_the_rest_counted(db):
    report = import_generator("home", {"rules.txt": WARNED.encode()})
    assert not report.is_refused
    assert len(report.problems) == StoredProblem.objects.count() == MOST_PROBLEMS + 1
    last = report.problems[-1]
    assert last.message.startswith("500 ")
    assert last.position.line == 2 * MOST_PROBLEMS + 2


def test_an_error_after_many_warnings_refuses_the_import(db):
    report = import_generator("home", {"rules.txt": f"{WARNED}$Main = (a\n".encode()})
    assert [error.position.line for error in report.errors] == [3_001]
    assert not StoredProblem.objects.exists()


def test_many_errors_are_told_in_part():
    errors = [error_at(Position("rules.txt", line), "no") for line in range(1, 5_001)]
    told = first_problems(errors)
    assert told[:MOST_PROBLEMS] == tuple(errors[:MOST_PROBLEMS])
    assert told[MOST_PROBLEMS:] == (
        error_at(
            Position("rules.txt", MOST_PROBLEMS + 1),
            "4,000 more problems from here on, not listed",
            "correct the listed ones first",
        ),
    )
