"""Compare the plans of a run's answers with those of the labels, by the recipes that its world has now."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from annotations.background.progress import Progress
from annotations.language.corpus import KNOWN, SplitItem
from annotations.rows.synchronise import BATCH, batches
from parser_service.analysis.outcomes import outcomes_of
from parser_service.analysis.scores import Judgement, judge, score
from parser_service.models import Evaluation, Prediction, TrainingRun
from parser_service.parsers.conditions import TEST_SOURCES
from parser_service.results.stored_columns import forget_answers
from parser_service.reviews.target import Target
from parser_service.runs.knowledge import plan_agreement_of
from parser_service.runs.split_pairs import cluster_of

AT_ONCE = 5_000  # rows read from the database
OF_EXAMPLE = ("source", "utterance", "source_command", "logical_form")


def plan_findings(target: Target, progress: Progress) -> dict[str, int]:
    """Compare all plans of the run, on every part. Returns how many answers are judged otherwise than before."""
    return {"changed": compare_plans(target.run, progress)}


def compare_plans(run: TrainingRun, progress: Progress) -> int:
    """Store for each answer of ``run`` whether it has the plan of its label, and count them anew.

    Of known forms no answers are kept, so that what is counted of them stays. Returns how many answers are judged
    otherwise than before. Raises what ``progress`` raises to stop it, and LanguageError where a text of the world
    cannot be read.
    """
    same_plan = plan_agreement_of(run.world)
    judged: dict[tuple[str, str], bool] = {}
    changed = 0
    for rows in _pages(run):
        progress.check()
        now: dict[bool, list[int]] = {True: [], False: []}
        for key, label, answer, before in rows:
            if (label, answer) not in judged:
                judged[label, answer] = bool(judge(answer, label, same_plan).is_same_plan)
            if judged[label, answer] is not before:
                now[judged[label, answer]].append(key)
        for is_same, keys in now.items():
            for some in batches(keys, BATCH):
                with progress.writing():
                    Prediction.objects.filter(pk__in=some).update(is_same_plan=is_same)
            changed += len(keys)
    for evaluation in run.evaluations.exclude(part=KNOWN):
        _count(run, evaluation, progress)
    with progress.writing():
        forget_answers(run)
    return changed


def _pages(run: TrainingRun) -> Iterator[list[tuple[int, str, str, bool | None]]]:
    """Yield key, label, answer and what is stored of their plans, of all candidates."""
    rows = run.predictions.order_by("pk")
    columns = ("pk", "example__logical_form", "logical_form", "is_same_plan")
    last = 0
    while page := list(rows.filter(pk__gt=last).values_list(*columns)[:AT_ONCE]):
        last = page[-1][0]
        yield page


def _count(run: TrainingRun, evaluation: Evaluation, progress: Progress) -> None:
    """Count the answers behind a score anew."""
    best = run.predictions.best().filter(
        example__part=evaluation.part,
        example__source__in=TEST_SOURCES[evaluation.test_source],
    )
    flags = ("is_exact_match", "is_equivalent", "is_well_formed", "is_same_plan")
    columns = (*(f"example__{name}" for name in OF_EXAMPLE), *flags)
    clusters: list[str] = []
    judgements: list[Judgement] = []
    row: tuple[Any, ...]
    for row in best.order_by("example_id").values_list(*columns).iterator(chunk_size=AT_ONCE):
        item = SplitItem(*row[: len(OF_EXAMPLE)])
        clusters.append(cluster_of(item, run.split.criterion))
        judgements.append(Judgement(*row[len(OF_EXAMPLE) :]))
    if not judgements:
        return  # its answers are gone
    evaluation.same_plan = score(judgements).same_plan
    evaluation.outcomes = outcomes_of(clusters, judgements)
    with progress.writing():
        evaluation.save(update_fields=["same_plan", "outcomes"])
