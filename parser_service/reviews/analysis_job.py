"""The error analysis of a run as a job: each step is stored when it is done, and not done again."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

from annotations.background.progress import Progress
from annotations.language.texts import Refusal
from annotations.models import Job
from annotations.models.background import Status
from parser_service.analysis.confusions import confuse_slots
from parser_service.models import TrainingRun
from parser_service.results.slot_confusions import SLOTS
from parser_service.results.stored_columns import answers_of, examples_of
from parser_service.reviews.attractor_findings import attractor_findings, attractors_in
from parser_service.reviews.category_proposals import propose_for_run
from parser_service.reviews.plan_comparison import plan_findings
from parser_service.reviews.probe_answers import answer_findings
from parser_service.reviews.probe_making import probe_findings
from parser_service.reviews.refusal_curves import refusal_findings
from parser_service.reviews.sensitivity_findings import (
    deciding_word_findings,
    pair_findings,
    sensitivity_findings,
)
from parser_service.reviews.stored_findings import findings_of, keep_finding
from parser_service.reviews.target import Target, parts_of

MOST_EXAMPLES = 500  # that are kept with a confusion
AT_ONCE = 20_000


def confusion_findings(target: Target, progress: Progress) -> dict[str, Any]:
    """Return the confusions of slots among a run's first answers on a part, as plain values.

    The columns of the run are stored too, so that the first comparison need not wait for them.

    Returns:
        ``rows``: predicate, place of the argument (from 1), kind in the label, kind in the answer, count; the
        most frequent first. ``examples``: ``PREDICATE:PLACE:LABELLED:ANSWERED`` → keys of examples with it.
    """
    progress.check()
    run, part = target.run, target.part
    answers_of(run, part, examples_of(run.split, part))
    columns = ("example_id", "example__logical_form", "logical_form")
    wrong = run.predictions.best().filter(example__part=part, is_exact_match=False).order_by()
    pairs: dict[tuple[str, str], list[int]] = defaultdict(list)
    for key, label, answer in wrong.values_list(*columns).iterator(chunk_size=AT_ONCE):
        pairs[label, answer].append(key)
    counts: dict[tuple[str, int, str, str], int] = defaultdict(int)
    examples: dict[tuple[str, int, str, str], list[int]] = defaultdict(list)
    for (label, answer), keys in pairs.items():
        for slot in confuse_slots([label], [answer]):
            if slot.is_error:
                confusion = (slot.predicate, slot.place, slot.gold, slot.predicted)
                counts[confusion] += slot.count * len(keys)
                examples[confusion] += keys[: MOST_EXAMPLES - len(examples[confusion])]
    ordered = sorted(counts, key=lambda confusion: (-counts[confusion], confusion))
    return {
        "rows": [[*confusion, counts[confusion]] for confusion in ordered],
        "examples": {":".join(map(str, each)): sorted(examples[each]) for each in ordered},
    }


def proposal_findings(target: Target, progress: Progress) -> dict[str, int]:
    """Store a proposal for each error of the run, on every part. Returns how many there are."""
    target.forget_answers()  # the proposals read all of them once more
    run = target.run
    attractors = (attractors_in(findings_of(run, part)) for part in parts_of(run))
    return {"proposed": propose_for_run(run, frozenset().union(*attractors), progress)}


@dataclass(frozen=True, slots=True)
class AnalysisStep:
    """``find`` returns what is kept under ``name``; ``share`` is its part of all the time.

    ``changes_with_world`` where it also goes by what people say meanwhile, so that it may be asked for again.
    """

    name: str
    activity: str
    find: Callable[[Target, Progress], Any]
    share: float = 1.0
    changes_with_world: bool = False


# What is found out for every part, and then for the first one alone, since it asks the parser.
OF_PARTS = (
    AnalysisStep("attractors", "looking for forms that attract unlike inputs", attractor_findings),
    AnalysisStep("risk_coverage", "drawing the risk–coverage curve", refusal_findings),
    AnalysisStep(SLOTS, "counting confusions of slots", confusion_findings),
)
OF_FIRST_PART = (
    AnalysisStep("plans", "comparing plans", plan_findings, 2, True),
    AnalysisStep("proposals", "proposing error categories", proposal_findings, 4, True),
    AnalysisStep("pairs", "comparing utterances one word apart", pair_findings),
    AnalysisStep("probes", "making probes", probe_findings, 2),
    AnalysisStep("answers", "asking the parser its probes", answer_findings, 20),
    AnalysisStep("sensitivity", "measuring what edits change", sensitivity_findings),
    AnalysisStep("deciding_words", "looking for deciding words", deciding_word_findings),
)


def names_of_steps() -> frozenset[str]:
    """Return what a complete analysis has found."""
    return frozenset(step.name for step in (*OF_PARTS, *OF_FIRST_PART))


def analyse(job: Job, progress: Progress) -> dict[str, Any]:
    """Analyse the run that the arguments of the job name. Returns the report of the job.

    What is stored already is not done again, but where ``again`` is asked for what changes with the world.

    Raises Refusal where the run is gone, has not succeeded, or its parser is not
    there to be asked, and what ``progress`` raises to stop it.
    """
    run = _run_of(job)
    parts = parts_of(run)
    if not parts:
        raise Refusal(
            f"Run {run.pk} has no answers on a validation or test part to analyse.",
            "nothing_to_analyse",
            HTTPStatus.CONFLICT,
        )
    targets = [Target(run, part) for part in parts]
    steps = [(target, step) for target in targets for step in OF_PARTS]
    steps += [(targets[0], step) for step in OF_FIRST_PART]
    total, done = sum(step.share for _, step in steps), 0.0
    for target, step in steps:
        for other in targets:
            if other is not target:
                other.forget_answers()  # one part of a million answers in memory is enough
        share = _Share(progress, done / total, step.share / total)
        share.report(0, f"{step.activity} ({target.part} part)")
        is_wanted = job.arguments.get("again") and step.changes_with_world
        if is_wanted or step.name not in findings_of(run, target.part):
            keep_finding(run, target.part, step.name, step.find(target, share), progress)
        done += step.share
    return _report(run, parts)


class _Share:
    """The progress of one step, as a share of the whole."""

    def __init__(self, progress: Progress, start: float, share: float) -> None:
        self._progress, self._start, self._share = progress, start, share

    def report(self, fraction: float, message: str) -> None:
        self._progress.report(self._start + fraction * self._share, message)

    def check(self) -> None:
        self._progress.check()

    def writing(self) -> AbstractContextManager[Any]:
        return self._progress.writing()

    def conclude(self, report: Mapping[str, Any]) -> None:
        raise NotImplementedError("A step is not the end of the job.")


def _run_of(job: Job) -> TrainingRun:
    runs = TrainingRun.objects.select_related("world", "split")
    run = runs.filter(world=job.world_id, pk=job.arguments.get("run")).first()
    if run is None:
        raise Refusal("The run that was to be analysed is gone.", "run_gone", HTTPStatus.CONFLICT)
    if run.status != Status.SUCCEEDED:
        raise Refusal(
            f"Run {run.pk} is {run.status}: only one that succeeded has errors to analyse.",
            "run_not_succeeded",
            HTTPStatus.CONFLICT,
        )
    return run


def _report(run: TrainingRun, parts: list[str]) -> dict[str, Any]:
    findings_by_part = {part: findings_of(run, part) for part in parts}
    return {
        "run": run.pk,
        "parser": run.parser,
        "parts": parts,
        "attractors": sum(
            row["is_attractor"]
            for findings in findings_by_part.values()
            for rows in findings["attractors"].values()
            for row in rows
        ),
        "probes": run.probes.filter(answer__isnull=False).count(),
    }
