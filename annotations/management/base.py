"""What the commands for scripts share: ``--json``, sentences for errors, exit status 1."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser
from django.db import DatabaseError

from annotations.background.failures import database_sentence, file_sentence
from annotations.language.corpus import Criterion
from annotations.language.texts import (
    ENCODINGS,
    LanguageError,
    Problem,
    Refusal,
    decode,
    normalise_line,
    why_outside,
)
from annotations.models import Split, World
from annotations.people.audit_log import record_command
from annotations.rows.stored_problems import from_json

NAMES = ("world", "name")  # options that are texts of rows, normalised as everywhere
MOST_EXCERPTS = 20  # errors that are shown with their line


class RefusedReport(Refusal):
    """Work that was refused, with the report that is printed all the same."""

    code = "refused_report"

    def __init__(self, report: Mapping[str, Any], sentences: list[str]):
        super().__init__("\n".join(sentences))
        self.report = report

    @classmethod
    def because(
        cls, errors: Sequence[Problem], report: Mapping[str, Any], folder: Path
    ) -> RefusedReport:
        """Return an import of ``folder`` that was refused for its errors, each shown with its line."""
        count = f"{len(errors)} error{'s' if len(errors) > 1 else ''}"
        shown = [_show(problem, folder) for problem in errors[:MOST_EXCERPTS]]
        rest = map(str, errors[MOST_EXCERPTS:])
        return cls(report, [*shown, *rest, f"Nothing was imported: {count}."])


class ReportingCommand(BaseCommand):
    """A command that answers with one report.

    A subclass gives ``add_options`` and ``report(**options)``, which returns a JSON-ready mapping or
    raises ``RefusedReport`` or ``Refusal``; None where it has printed its answers already. With ``--json``
    the report is the only thing on standard output. Errors go to standard error as sentences, and the exit
    status is 1.

    What a command with ``audited`` has done goes into the audit log under these words, for the world that
    its option ``world`` names; ``audit_subject`` says what it was about.
    """

    audited = ""

    # The checks read every URL and view; a script that runs often should not pay for them.
    requires_system_checks: list[str] = []

    def create_parser(self, *args: Any, **options: Any) -> CommandParser:
        """Refuse abbreviated options: else ``--set`` would be Django's ``--settings``."""
        return super().create_parser(*args, allow_abbrev=False, **options)

    def add_arguments(self, parser: CommandParser) -> None:
        self.add_options(parser)
        parser.add_argument(
            "--json", action="store_true", help="print one JSON object and nothing else"
        )

    def add_options(self, parser: CommandParser) -> None:
        """Declares the arguments of this command."""

    # A subclass names the options that it takes.
    report: Callable[..., Mapping[str, Any] | None]

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        """Return what the work was about, never a secret."""
        return ""

    def describe(self, report: Mapping[str, Any]) -> str:
        """Return the report for a person: one figure a line, then the problems, one a line."""
        figures = [
            f"{key}: {_in_words(value)}" for key, value in report.items() if value is not None
        ]
        problems = report.get("problems", ())
        return "\n".join([*figures, *(f"  {from_json(problem)}" for problem in problems)])

    def handle(self, *args: Any, **options: Any) -> None:
        for name in NAMES:
            if isinstance(options.get(name), str):
                options[name] = normalise_line(options[name])
        try:
            report = self.report(**options)
        except RefusedReport as error:
            self._print(error.report, options["json"])
            raise CommandError(str(error)) from None
        except DatabaseError as error:
            raise CommandError(database_sentence(error)) from error
        except LanguageError as error:
            placeless = f"{error.message} ({error.hint})" if error.hint else error.message
            raise CommandError(str(error) if error.source else placeless) from error
        except Refusal as refusal:
            raise CommandError(refusal.message) from refusal
        except OSError as error:
            raise CommandError(file_sentence(error)) from error
        if report is None:
            return
        if self.audited:
            world = World.objects.filter(name=options.get("world") or "").first()
            record_command(self.audited, self.audit_subject(report, options), world)
        self._print(report, options["json"])

    def _print(self, report: Mapping[str, Any], as_json: bool) -> None:
        text = json.dumps(report, ensure_ascii=False) if as_json else self.describe(report)
        self.stdout.write(text)


class ImportCommand(ReportingCommand):
    """Imports a folder or an archive into a world; says what it left out."""

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("folder", type=Path, help="or an archive: .zip, .tar, .tar.gz")
        parser.add_argument("--world", required=True, help="made where there is none")
        parser.add_argument(
            "--bring-back",
            action="store_true",
            help="restore what people have deleted in the world; left out without it",
        )
        parser.add_argument(
            "--encoding",
            choices=ENCODINGS,
            metavar="ENCODING",
            default="",
            help="of files that are not UTF-8; refused without it, with what encodings would read: "
            + ", ".join(ENCODINGS),
        )

    def audit_subject(self, report: Mapping[str, Any], options: Mapping[str, Any]) -> str:
        return str(options["folder"])

    def describe(self, report: Mapping[str, Any]) -> str:
        left_out = report["left_out"]
        rows = chain(*left_out.values()) if isinstance(left_out, Mapping) else left_out
        return "\n".join([super().describe(report), *(f"  left out: {row}" for row in rows)])


def _show(problem: Problem, folder: Path) -> str:
    """Return the problem, and below it the line of its file with a caret at its column."""
    try:
        path = folder / problem.position.source
        if why_outside(path, folder):
            return str(problem)
        excerpt = problem.position.excerpt(decode(path.read_bytes(), path.name))
    except (OSError, LanguageError, ValueError):
        return str(problem)  # of no file, or of one that cannot be read
    lines = "".join(f"\n    {line}" for line in excerpt.splitlines() if excerpt.strip(" ^\n"))
    return f"{problem}{lines}"


def _in_words(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_in_words(item)}" for key, item in value.items()) or "none"
    return str(len(value)) if isinstance(value, list) else str(value)


def find_world(name: str) -> World:
    """Return the world called ``name``. Raises CommandError with the names that exist."""
    world = World.objects.filter(name=name).first()
    if world is None:
        names = ", ".join(World.objects.values_list("name", flat=True)) or "none"
        raise CommandError(f"There is no world “{name}”. Worlds here: {names}.")
    return world


def find_split(world: World, name: str, criterion: str = Criterion.COMMAND) -> Split:
    """Return the split of ``world`` called ``name``, the one by ``criterion`` where several share a name.
    Raises CommandError with the names that exist.
    """
    split = world.splits.named(name, criterion)
    if split is None:
        names = ", ".join(world.splits.values_list("name", flat=True)) or "none"
        raise CommandError(f"“{world}” has no split “{name}”. It has: {names}.")
    return split
