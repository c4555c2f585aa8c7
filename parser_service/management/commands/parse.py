"""``parse TEXT --world W`` and ``parse --file FILE --world W``: the answers of a parser to utterances."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import CommandParser

from annotations.language.texts import Refusal
from annotations.management.base import ReportingCommand, find_world
from annotations.templatetags.task_plans import call
from parser_service.parsers.registry import untrained
from parser_service.runs.evaluating import BEAM_WIDTH
from parser_service.serving.answerer import Answerer
from parser_service.serving.line_files import answer_file, require_utf8
from parser_service.serving.lines import LineAnswer
from parser_service.serving.metrics import Metrics
from parser_service.serving.preparing import require_utterance
from parser_service.serving.shelf import Shelf

STANDARD_INPUT = "-"


class Command(ReportingCommand):
    help = (
        "Parse an utterance, or every line of a file, as a robot would: the grammar oracle answers first, then the "
        "promoted run. A run or a parser that needs none can be asked alone."
    )

    def add_options(self, parser: CommandParser) -> None:
        what = parser.add_mutually_exclusive_group(required=True)
        what.add_argument("text", nargs="?", help="the utterance")
        what.add_argument(
            "--file",
            help="a file with an utterance in each line, plain or as JSON lines; - is the standard input",
        )
        parser.add_argument("--world", required=True)
        who = parser.add_mutually_exclusive_group()
        who.add_argument(
            "--run",
            type=int,
            help="number of a succeeded run that answers alone (default: the oracle, then the promoted run)",
        )
        who.add_argument(
            "--parser",
            choices=untrained(),
            help="a parser made of what the world says now, without a run",
        )
        parser.add_argument(
            "--beam", type=int, default=BEAM_WIDTH, help="largest number of candidates"
        )

    def report(
        self, *, text: str | None, file: str | None, world: str, **options: Any
    ) -> Mapping[str, Any] | None:
        utterance = "" if text is None else require_utterance(text)
        if options["beam"] < 1:
            raise Refusal("--beam has to be at least 1.", "option_out_of_range")
        if file not in (None, STANDARD_INPUT):
            require_utf8(Path(file))
        found = find_world(world)
        # Nobody else waits: a language model may take as long as it needs.
        shelf = Shelf(settings.PARSER_MEMORY_MB * 1_000_000, Metrics(), patience=math.inf)
        answerer = shelf.load(found.name, options["run"], options["parser"] or "")
        if file is not None:
            self._answer_file(answerer, file, options["beam"], options["json"])
            return None
        [answer] = answerer.parse([utterance], options["beam"])
        report: Mapping[str, Any] = json.loads(answer)
        return report

    def _answer_file(self, answerer: Answerer, name: str, beam: int, as_json: bool) -> None:
        """Print the answer to each line of a file as soon as it is there.

        Raises Refusal at the end where some lines could not be parsed.
        """
        blank = json.loads(answerer.write(answerer.heard_nothing()))
        faults: list[LineAnswer] = []
        count = 0
        is_standard = name == STANDARD_INPUT
        with open(0 if is_standard else name, "rb", closefd=not is_standard) as lines:
            try:
                for answers in answer_file(answerer, lines, beam):
                    for each in answers:
                        self.stdout.write(self._say(each, blank, as_json))
                    self.stdout.flush()
                    faults += [each for each in answers if each.fault]
                    count += len(answers)
            except BrokenPipeError:
                # Whoever reads the answers, such as head, has enough. Python would complain once more at its end.
                os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        if faults:
            raise Refusal(
                f"{len(faults):,} of {count:,} lines could not be parsed. The first is line {faults[0].number}: "
                f"{faults[0].fault}",
                "lines_refused",
            )

    def _say(self, answer: LineAnswer, blank: Mapping[str, Any], as_json: bool) -> str:
        if as_json and not answer.fault:
            return answer.json
        if answer.fault:
            report = {**blank, "line": answer.number, "error": answer.fault}
            return json.dumps(report, ensure_ascii=False) if as_json else f"{answer.fault}\n"
        return f"{self.describe(json.loads(answer.json))}\n"

    def describe(self, report: Mapping[str, Any]) -> str:
        who = f"{report['parser']} (run {report['run']})" if report["run"] else report["parser"]
        lines = [f"{who}: {report['parsed_text']}", f"{report['sureness']}. {report['spoken']}"]
        lines += [f"{each['sureness']}: {each['utterance']}" for each in report["several"]]
        for candidate in report["candidates"]:
            shown = candidate["reading"] or f"{candidate['form']}   (no well-formed form)"
            lines.append(f"{candidate['score']:8.3f}  {shown}")
        best = report["candidates"][0]["warnings"] if report["candidates"] else ["no answer"]
        if report["candidates"]:
            lines += _say_plan(report["candidates"][0])
        if report["is_cut"]:
            lines.append("The text is longer than the parser reads: it read only the beginning.")
        return "\n".join([*lines, *report["warnings"], *best])


def _say_plan(candidate: Mapping[str, Any]) -> list[str]:
    """Return the steps of the task plan, and what is wrong with it."""
    plan = candidate["task_plan"]
    if not plan:
        return []
    steps = [f"{each['number']:8}  {call(each)}" for each in plan["steps"]]
    return [*steps, *(each["message"] for each in plan["problems"])]
