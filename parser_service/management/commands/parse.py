"""``parse TEXT --world W``: the answers of a trained parser to an utterance."""

from __future__ import annotations

from collections.abc import Mapping
from http import HTTPStatus
from typing import Any

from django.core.management.base import CommandParser

from annotations.language.errors import Refusal
from annotations.management.base import ReportingCommand, find_world
from annotations.models import World
from parser_service.models import TrainingRun
from parser_service.runs.training.evaluating import BEAM_WIDTH
from parser_service.serving.default_runs import best_run
from parser_service.serving.parse_answers import parse
from parser_service.serving.preparing import require_utterance


class Command(ReportingCommand):
    help = "Parse an utterance with the best parser trained in a world, or with that of a run."

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("text")
        parser.add_argument("--world", required=True)
        parser.add_argument("--run", type=int, help="number of a succeeded run (default: the best)")
        parser.add_argument(
            "--beam", type=int, default=BEAM_WIDTH, help="largest number of candidates"
        )

    def report(self, *, text: str, world: str, **options: Any) -> Mapping[str, Any]:
        utterance = require_utterance(text)
        if options["beam"] < 1:
            raise Refusal("--beam has to be at least 1.", "option_out_of_range")
        run = find_run(find_world(world), options["run"])
        answers = parse(run, utterance, options["beam"]).as_json()
        return {"run": run.pk, "parser": run.parser, **answers}

    def describe(self, report: Mapping[str, Any]) -> str:
        lines = [f"{report['parser']} (run {report['run']}): {report['parsed_text']}"]
        for candidate in report["candidates"]:
            shown = candidate["reading"] or f"{candidate['form']}   (no well-formed form)"
            lines.append(f"{candidate['score']:8.3f}  {shown}")
        best = report["candidates"][0]["remarks"] if report["candidates"] else ["no answer"]
        if report["is_cut"]:
            lines.append("The text is longer than the parser reads: it read only the beginning.")
        return "\n".join([*lines, *report["remarks"], *best])


def find_run(world: World, number: int | None) -> TrainingRun:
    """Return run ``number`` of ``world``, or its best. Raises Refusal where there is none."""
    if number is None:
        return best_run(world)
    run = world.runs.filter(pk=number).first()
    if run is None:
        raise Refusal(f"There is no run {number} in {world}.", "no_such_run", HTTPStatus.NOT_FOUND)
    return run
