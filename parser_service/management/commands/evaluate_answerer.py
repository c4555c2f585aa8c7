"""``evaluate_answerer W``: what a robot gets in a world, how sure it is told to be, and the time an answer takes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from django.core.management.base import CommandParser

from annotations.language.texts import Refusal
from annotations.management.base import ReportingCommand, find_split, find_world
from parser_service.models import AnswererEvaluation, AnsweringOrder
from parser_service.models.answering import answering_of
from parser_service.results.answerer_figures import evaluate_answerer
from parser_service.results.answerer_rows import as_row, bins_of, reliability_of
from parser_service.results.measuring_job import answerer_of, usual_split

_COLUMNS = ("correct", "same_plan", "acted", "wrong_acts", "confirmed", "asked", "refused")


class Command(ReportingCommand):
    help = (
        "Asks what answers in a world for each validation and test example of a split, calibrates how sure it is on "
        "what people said in the validation part, and stores what a robot gets: exact match, same plan, wrong acts, "
        "and how often it acts, confirms, asks and refuses. Results and the overview show it."
    )
    audited = "measure what a robot gets"

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument(
            "--split",
            help="its name (default: the one that says most about the parsers of the world)",
        )
        parser.add_argument(
            "--order",
            choices=[str(order) for order in AnsweringOrder],
            action="append",
            help="which parts answer; may be given several times (default: what the world has chosen)",
        )
        parser.add_argument(
            "--allowed-wrong",
            type=float,
            metavar="SHARE",
            help="of what is acted on at once, from 0 to 0.5 (default: what the world has chosen)",
        )

    def report(
        self,
        *,
        world: str,
        split: str | None,
        order: list[str] | None,
        allowed_wrong: float | None,
        **options: Any,
    ) -> Mapping[str, Any]:
        if allowed_wrong is not None and not 0 <= allowed_wrong <= 0.5:
            raise Refusal(
                f"--allowed-wrong is {allowed_wrong}; it has to be from 0 to 0.5.",
                "option_out_of_range",
            )
        home = find_world(world)
        chosen = find_split(home, split) if split else usual_split(home)
        orders = order or [answering_of(home).order]
        rows = [
            row
            for each in orders
            for row in evaluate_answerer(
                home, chosen, answerer_of(home, each), allowed_wrong=allowed_wrong
            )
        ]
        return {"world": world, "split": chosen.name, "rows": [_describe(row) for row in rows]}

    def describe(self, report: Mapping[str, Any]) -> str:
        return "\n".join(_lines(report))


def _describe(row: AnswererEvaluation) -> dict[str, Any]:
    measured = reliability_of([row])
    error = measured.error if measured else None
    bins = list(bins_of(measured)) if measured else []
    return {**as_row(row), "reliability": {"error": error, "bins": bins}}


def _lines(report: Mapping[str, Any]) -> Iterator[str]:
    yield f"{report['world']}, split {report['split']}; percent with 95 % intervals"
    for row in report["rows"]:
        yield ""
        milliseconds = 1000 * row["seconds"]
        yield (
            f"{row['order']}, {row['test_source']}, {row['part']}: {row['count']:,} examples; acts from "
            f"{row['act_from']:.3f} on; calibrated on {row['calibrated_on']:,} of people; {milliseconds:.1f} ms each"
        )
        for name in _COLUMNS:
            yield f"  {name.replace('_', ' '):<12}{_share(row[name], row[f'{name}_interval'])}"
        yield f"  Brier score {_number(row['brier_before'])} before, {_number(row['brier'])} after"
        yield f"  calibration error {_number(row['reliability']['error'])}"
        for each in row["reliability"]["bins"]:
            yield (
                f"    said {100 * each['said']:5.1f}: right {_share(each['right'], each['interval'])} "
                f"of {each['count']:,}"
            )


def _share(share: float | None, interval: Sequence[float] | None) -> str:
    if share is None or interval is None:
        return "    –"
    low, high = (100 * end for end in interval)
    return f"{100 * share:5.1f} ({low:.1f}–{high:.1f})"


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"
