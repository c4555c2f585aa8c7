"""``export_run W RUN… --to mlflow|tensorboard --output FOLDER``: curves and scores of runs for other programs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.core.management.base import CommandParser

from annotations.language.texts import Refusal
from annotations.management.base import ReportingCommand, find_world
from parser_service.models import TrainingRun
from parser_service.results.run_logs import LogFormat, export_runs


class Command(ReportingCommand):
    help = (
        "Writes the configuration, curves and scores of runs that have succeeded as MLflow or TensorBoard keep them. "
        "Needs their packages: the extra [tracking]."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("run", type=int, nargs="+", help="the number of a run")
        parser.add_argument("--to", choices=[*LogFormat], required=True)
        parser.add_argument(
            "--output",
            required=True,
            metavar="FOLDER",
            help="a folder; for mlflow also the address of a server, such as http://localhost:5000",
        )

    def report(
        self, *, world: str, run: list[int], to: str, output: str, **options: Any
    ) -> Mapping[str, Any]:
        home = find_world(world)
        runs: list[TrainingRun] = []
        for number in dict.fromkeys(run):
            row = home.runs.succeeded().select_related("world", "split").filter(pk=number).first()
            if row is None:
                raise Refusal(f"{home} has no run {number} that has succeeded.", "no_such_run")
            runs.append(row)
        return {"to": to, "runs": export_runs(runs, to, output)}

    def describe(self, report: Mapping[str, Any]) -> str:
        return "\n".join(report["runs"])
