"""What the best parser of a world answers to its unlabelled utterances. A worker computes it: torch is loaded."""

from __future__ import annotations

from typing import Any

from django.db.models import Exists, OuterRef

from annotations.background.progress import Progress
from annotations.models import Job, Proposal, Utterance, World
from annotations.rows.synchronise import batches
from parser_service.candidates.composing import is_label
from parser_service.candidates.doubting import enqueue_doubts
from parser_service.models import TrainingRun
from parser_service.parsers.conditions import TrainSources
from parser_service.parsers.interface import Candidate, Parser
from parser_service.serving import best_run, load_parser

MOST_AT_ONCE = 5_000  # utterances of one job, the oldest first
BEAM_WIDTH = 5
TOGETHER = 64


def propose(job: Job, progress: Progress) -> dict[str, Any]:
    """Store what the best run answers to every unlabelled utterance that has no answer of it yet.

    Returns the report of the job. Without a trained parser there is nothing to do, and the report
    says so.
    """
    if job.world is None:
        return {"proposed": 0, "sentence": f"There is no world {job.world_name} any more."}
    try:
        run = best_run(job.world)
        parser = load_parser(run)
    except ValueError as error:
        return {"proposed": 0, "sentence": str(error)}
    rows = list(_without_answer(job.world, run)[:MOST_AT_ONCE])
    done = 0
    for some in batches(rows, TOGETHER):
        progress.report(done / len(rows), "asking the parser")
        _answer(some, run, parser, progress)
        done += len(some)
    with progress.writing():
        enqueue_doubts(job.world, rows)
    return {"proposed": done, "parser": run.parser, "run": run.pk}


def _without_answer(world: World, run: TrainingRun) -> Any:
    answered = Proposal.objects.filter(utterance=OuterRef("pk"), run=run.pk)
    return world.utterances.unlabelled().filter(~Exists(answered)).order_by("pk")


def _answer(rows: list[Utterance], run: TrainingRun, parser: Parser, progress: Progress) -> None:
    """Replace what an earlier run answered to these utterances."""
    is_anonymous = run.train_sources == TrainSources.GENERATED
    texts = [row.anonymized_text if is_anonymous else row.text for row in rows]
    answers = parser.predict(texts, BEAM_WIDTH, progress.check)
    made = [
        Proposal(
            utterance=row,
            source=run.parser,
            run=run.pk,
            rank=rank,
            form=candidate.form,
            score=candidate.score,
        )
        for row, candidates in zip(rows, answers, strict=True)
        for rank, candidate in enumerate(_labels(candidates), start=1)
    ]
    with progress.writing():
        Proposal.objects.filter(utterance__in=rows).delete()
        Proposal.objects.bulk_create(made)


def _labels(candidates: list[Candidate]) -> list[Candidate]:
    return [candidate for candidate in candidates if is_label(candidate.form)]
