"""The error analysis of a run as a job: each step is stored when it is done, and not done again."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

from annotations.background.progress import Progress
from annotations.models import Job
from parser_service.analysing.attracting import attractor_findings
from parser_service.analysing.confusing import confusion_findings
from parser_service.analysing.findings import findings_of, keep_finding
from parser_service.analysing.probes.asking import answer_findings
from parser_service.analysing.probes.probing import probe_findings
from parser_service.analysing.probes.sensing import (
    deciding_word_findings,
    pair_findings,
    sensitivity_findings,
)
from parser_service.analysing.proposing import proposal_findings
from parser_service.analysing.refusals.refusing import refusal_findings
from parser_service.analysing.target import Target, parts_of
from parser_service.models import TrainingRun
from parser_service.models.runs import Status
from parser_service.slices.slots import SLOTS


@dataclass(frozen=True, slots=True)
class Step:
    """``find`` returns what is kept under ``name``; ``share`` is its part of all the time.

    ``changes_with_world`` where it also goes by what people say meanwhile, so that it may be asked for again.
    """

    name: str
    activity: str
    find: Callable[[Target, Progress], Any]
    share: float = 1.0
    changes_with_world: bool = False


def _find_confusions(target: Target, progress: Progress) -> dict[str, Any]:
    progress.check()
    return confusion_findings(target.run, target.part)


# What is found out for every part, and then for the first one alone, since it asks the parser.
OF_PARTS = (
    Step("attractors", "looking for forms that attract unlike inputs", attractor_findings),
    Step("risk_coverage", "drawing the risk–coverage curve", refusal_findings),
    Step(SLOTS, "counting confusions of slots", _find_confusions),
)
OF_FIRST_PART = (
    Step("proposals", "proposing error categories", proposal_findings, 4, True),
    Step("pairs", "comparing utterances one word apart", pair_findings),
    Step("probes", "making probes", probe_findings, 2),
    Step("answers", "asking the parser its probes", answer_findings, 20),
    Step("sensitivity", "measuring what edits change", sensitivity_findings),
    Step("deciding_words", "looking for deciding words", deciding_word_findings),
)


def names_of_steps() -> frozenset[str]:
    """Return what a complete analysis has found."""
    return frozenset(step.name for step in (*OF_PARTS, *OF_FIRST_PART))


def analyse(job: Job, progress: Progress) -> dict[str, Any]:
    """Analyse the run that the arguments of the job name. Returns the report of the job.

    What is stored already is not done again, but where ``again`` is asked for what changes with the world.

    Raises ValueError, a sentence, where the run is gone, has not succeeded, or its parser is not
    there to be asked, and what ``progress`` raises to stop it.
    """
    run = _run_of(job)
    parts = parts_of(run)
    if not parts:
        raise ValueError(f"Run {run.pk} has no answers on a validation or test part to analyse.")
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
        raise ValueError("The run that was to be analysed is gone.")
    if run.status != Status.SUCCEEDED:
        raise ValueError(
            f"Run {run.pk} is {run.status}: only one that succeeded has errors to analyse."
        )
    return run


def _report(run: TrainingRun, parts: list[str]) -> dict[str, Any]:
    found = {part: findings_of(run, part) for part in parts}
    return {
        "run": run.pk,
        "parser": run.parser,
        "parts": parts,
        "attractors": sum(
            row["is_attractor"]
            for findings in found.values()
            for rows in findings["attractors"].values()
            for row in rows
        ),
        "probes": run.probes.filter(answer__isnull=False).count(),
    }
