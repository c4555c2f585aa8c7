"""``evaluate_answerer W``: what a robot gets in a world, how sure it is told to be, and the time an answer takes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import log
from time import process_time
from typing import Any

from django.core.management.base import CommandParser

from annotations.language.errors import Refusal
from annotations.language.grounding import deanonymize
from annotations.management.base import ReportingCommand, find_split, find_world
from annotations.models import Split, World
from parser_service.analysis.probabilities import probability_of
from parser_service.analysis.sureness import AnsweredForm, AnsweringPart, Evidence
from parser_service.models import AnswererEvaluation, AnsweringOrder, TrainingRun
from parser_service.models.answering import answering_of
from parser_service.parsers.interface import UNKNOWN, Candidate, Parser, ScoreKind
from parser_service.results.answerer_figures import evaluate_answerer
from parser_service.results.answerer_rows import as_row, bins_of, reliability_of
from parser_service.serving.default_runs import answering_run, standings
from parser_service.serving.loading import load_parser, make_untrained
from parser_service.serving.parse_answers import Reading, answer_with, form_of
from parser_service.serving.preparing import WorldLanguage

_BEAM = 5
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
        chosen = find_split(home, split) if split else _usual_split(home)
        orders = order or [answering_of(home).order]
        rows = [
            row
            for each in orders
            for row in evaluate_answerer(
                home, chosen, PartsInOrder.of(home, each), allowed_wrong=allowed_wrong
            )
        ]
        return {"world": world, "split": chosen.name, "rows": [_describe(row) for row in rows]}

    def describe(self, report: Mapping[str, Any]) -> str:
        return "\n".join(_lines(report))


def _usual_split(world: World) -> Split:
    """Return the split that pages open on, else the newest. Raises Refusal where there is none."""
    if standing := next(standings(world), None):
        return standing.split
    split = world.splits.order_by("-pk").first()
    if split is None:
        raise Refusal(f"“{world}” has no split. Freeze one, then measure.", "no_split")
    return split


def _describe(row: AnswererEvaluation) -> dict[str, Any]:
    measured = reliability_of([row])
    about = {"error": None, "bins": []}
    if measured:
        about = {"error": measured.error, "bins": list(bins_of(measured))}
    return {**as_row(row), "reliability": about}


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


def _log_probability(candidate: Candidate, kind: ScoreKind | None) -> float | None:
    probability = probability_of(candidate.score, kind)
    return None if probability is None else log(max(probability, 1e-30))


@dataclass(frozen=True)
class PartsInOrder:
    """Asks the grammar oracle, and the learned parser of ``run`` where that is silent."""

    order: str
    run: TrainingRun | None
    oracle: Parser | None
    learned: Parser | None
    language: WorldLanguage

    @classmethod
    def of(cls, world: World, order: str) -> PartsInOrder:
        """Return what answers in ``world``. Raises Refusal where nothing can."""
        run = oracle = None
        missing: list[Refusal] = []
        if order != AnsweringOrder.ORACLE:
            try:
                run = answering_run(world)
            except Refusal as error:
                missing.append(error)
        if order != AnsweringOrder.LEARNED:
            try:
                oracle = make_untrained("grammar-oracle", world)
            except Refusal as error:
                missing.append(error)
        if run is None and oracle is None:
            raise missing[0]
        learned = load_parser(run).hesitant() if run else None
        return cls(order, run, oracle, learned, WorldLanguage.of(world))

    def answer(self, utterances: Sequence[str]) -> list[AnsweredForm]:
        return [self._answer(each) for each in utterances]

    def _answer(self, utterance: str) -> AnsweredForm:
        began = process_time()
        for name, parser in (
            (AnsweringPart.ORACLE, self.oracle),
            (AnsweringPart.LEARNED, self.learned),
        ):
            candidates = parser.predict([utterance], _BEAM)[0] if parser else []
            if parser and candidates and candidates[0].form != UNKNOWN:
                return self._judge(name, utterance, candidates, parser.score_kind, began)
        return AnsweredForm(seconds=process_time() - began)

    def _judge(
        self,
        part: AnsweringPart,
        utterance: str,
        candidates: Sequence[Candidate],
        kind: ScoreKind | None,
        began: float,
    ) -> AnsweredForm:
        best, *others = candidates
        form = form_of(best.form)
        if form is None:
            return AnsweredForm(seconds=process_time() - began)
        language = self.language
        heard = language.anonymizer.anonymize(utterance)
        given = deanonymize(form, heard, language.ontology, language.evidence, best.values)
        answer = answer_with(best, given, language, language.lookup)
        _, not_said, left_out, _ = Reading(best, answer, given.slots).misfit(heard)
        own = [_log_probability(each, kind) for each in candidates]
        evidence = Evidence(
            part,
            is_exact=best.score == 0,
            heard_cost=max(-best.score, 0.0),
            readings=1 + sum(each.score == best.score for each in others),
            learned_log_probability=own[0],
            margin=own[0] - own[1]
            if others and own[0] is not None and own[1] is not None
            else None,
            not_said=int(not_said),
            left_out=left_out,
            executable=answer.executable_plans > 0,
        )
        ambiguous = any(slot.is_ambiguous for slot in given.slots)
        seconds = process_time() - began
        return AnsweredForm(
            best.form, evidence, bool(not_said), ambiguous=ambiguous, seconds=seconds
        )
