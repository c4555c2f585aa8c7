"""What the best parser of a world answers to utterances and commands. A worker computes it: torch is loaded."""

from __future__ import annotations

from typing import Any

from django.db.models import Exists, OuterRef

from annotations.background.progress import Progress
from annotations.models import CommandProposal, Job, Proposal, Utterance, World
from annotations.rows.synchronise import batches
from parser_service.candidates.composing import PERSON, is_label
from parser_service.candidates.doubting import enqueue_doubts
from parser_service.models import TrainingRun
from parser_service.parsers.conditions import TrainSources
from parser_service.parsers.interface import Candidate, Parser
from parser_service.serving.choosing import best_run
from parser_service.serving.loading import load_parser

MOST_AT_ONCE = 5_000  # utterances of one job, the oldest first
BEAM_WIDTH = 5
TOGETHER = 64


def propose(job: Job, progress: Progress) -> dict[str, Any]:
    """Store what the best run answers to every unlabelled utterance that has no answer of it yet.

    A job with a ``command`` and a ``run`` among its arguments stores what that run answers to the command.
    Returns the report of the job. Without a trained parser there is nothing to do, and the report
    says so.
    """
    if job.world is None:
        return {"proposed": 0, "sentence": f"There is no world {job.world_name} any more."}
    command = job.arguments.get("command")
    try:
        run = _run_of(job) if command else best_run(job.world)
        parser = load_parser(run)
    except ValueError as error:
        return {"proposed": 0, "sentence": str(error)}
    if command:
        return _answer_command(job.world, command, run, parser, progress)
    rows = list(_without_answer(job.world, run)[:MOST_AT_ONCE])
    done = 0
    for some in batches(rows, TOGETHER):
        progress.report(done / len(rows), "asking the parser")
        _answer(some, run, parser, progress)
        done += len(some)
    with progress.writing():
        enqueue_doubts(job.world, rows)
    return {"proposed": done, "parser": run.parser, "run": run.pk}


def _run_of(job: Job) -> TrainingRun:
    run = TrainingRun.objects.filter(world=job.world, pk=job.arguments["run"]).first()
    if run is None:
        raise ValueError("The run that was asked is gone.")
    return run


def _answer_command(
    world: World, command: str, run: TrainingRun, parser: Parser, progress: Progress
) -> dict[str, Any]:
    """Replace what any run answered to an anonymized command."""
    (answers,) = parser.predict([command], BEAM_WIDTH, progress.check)
    made = [CommandProposal(world=world, command=command, **each) for each in _rows(answers, run)]
    with progress.writing():
        World.objects.select_for_update().get(pk=world.pk)  # one of two jobs waits
        world.command_proposals.filter(command=command).delete()
        CommandProposal.objects.bulk_create(made)
    return {"proposed": 1, "parser": run.parser, "run": run.pk, "command": command}


def _without_answer(world: World, run: TrainingRun) -> Any:
    answered = Proposal.objects.filter(utterance=OuterRef("pk"), run=run.pk)
    return world.utterances.unlabelled().filter(~Exists(answered)).order_by("pk")


def _answer(rows: list[Utterance], run: TrainingRun, parser: Parser, progress: Progress) -> None:
    """Replace what an earlier run answered to these utterances."""
    is_anonymous = run.train_sources == TrainSources.GENERATED
    texts = [row.anonymized_text if is_anonymous else row.text for row in rows]
    answers = parser.predict(texts, BEAM_WIDTH, progress.check)
    made = [
        Proposal(utterance=row, **each)
        for row, candidates in zip(rows, answers, strict=True)
        for each in _rows(candidates, run)
    ]
    with progress.writing():
        Proposal.objects.filter(utterance__in=rows).exclude(source=PERSON).delete()
        Proposal.objects.bulk_create(made)


def _rows(candidates: list[Candidate], run: TrainingRun) -> list[dict[str, Any]]:
    """Return the fields of the proposals that an answer makes: its forms that can be labels, ranked."""
    labels = [candidate for candidate in candidates if is_label(candidate.form)]
    return [
        {
            "source": run.parser,
            "run": run.pk,
            "rank": rank,
            "form": candidate.form,
            "score": candidate.score,
        }
        for rank, candidate in enumerate(labels, start=1)
    ]
