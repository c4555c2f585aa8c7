"""What the best parser of a world answers to utterances and commands. A worker computes it: torch is loaded."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from http import HTTPStatus
from typing import Any

from django.db.models import Exists, OuterRef

from annotations.background.progress import Progress
from annotations.labelling.enqueuing import WantedItem, enqueue
from annotations.language.texts import Refusal
from annotations.models import CommandProposal, Job, Proposal, Utterance, WorkKind, World
from annotations.rows.synchronise import batches
from parser_service.labelling.known_forms import derived_forms, nearest_forms
from parser_service.labelling.label_candidates import PERSON, is_label
from parser_service.labelling.submission_readings import read_submissions
from parser_service.models import TrainingRun
from parser_service.parsers.interface import Candidate, Parser
from parser_service.parsers.registry import title_of
from parser_service.serving.default_runs import best_run
from parser_service.serving.loading import load_parser

MOST_AT_ONCE = 5_000  # utterances of one job, the oldest first
BEAM_WIDTH = 5
TOGETHER = 64
UNSURE_SHARE = 0.1  # scores compare within one parser only, so the least sure tenth is taken


def propose(job: Job, progress: Progress) -> dict[str, Any]:
    """Store what the best run answers to every unlabelled utterance that has no answer of it yet, and flag what
    contributors wrote that it reads as another form.

    A job with a ``command`` and a ``run`` among its arguments stores what that run answers to the command.
    Returns the report of the job. Without a trained parser there is nothing to do, and the report
    says so.
    """
    if job.world is None:
        return {"proposed": 0, "sentence": f"There is no world {job.world_name} any more."}
    command = job.arguments.get("command")
    try:
        if command:
            run = TrainingRun.objects.filter(world=job.world, pk=job.arguments["run"]).first()
            if run is None:
                raise Refusal("The run that was asked is gone.", "run_gone", HTTPStatus.CONFLICT)
        else:
            run = best_run(job.world)
        parser = load_parser(run)
    except Refusal as error:
        return {"proposed": 0, "sentence": error.message}
    if command:
        return _answer_command(job.world, command, run, parser, progress)
    answered = Proposal.objects.filter(utterance=OuterRef("pk"), run=run.pk)
    unanswered = job.world.utterances.unlabelled().filter(~Exists(answered)).order_by("pk")
    rows = list(unanswered[:MOST_AT_ONCE])
    done = 0
    for some in batches(rows, TOGETHER):
        progress.report(done / len(rows), "asking the parser")
        _answer(some, run, parser, progress)
        done += len(some)
    enqueue_doubts(job.world, rows, progress)
    read = read_submissions(job.world, run, parser, progress)
    return {"proposed": done, "parser": run.parser, "run": run.pk, **read}


def _answer_command(
    world: World, command: str, run: TrainingRun, parser: Parser, progress: Progress
) -> dict[str, Any]:
    """Replace what any run answered to an anonymized command."""
    (answers,) = parser.predict([command], BEAM_WIDTH, progress.check)
    made = [CommandProposal(world=world, command=command, **each) for each in _rows(answers, run)]
    with progress.writing():
        World.objects.hold().get(pk=world.pk)  # one of two jobs waits
        world.command_proposals.filter(command=command).delete()
        CommandProposal.objects.bulk_create(made)
    return {"proposed": 1, "parser": run.parser, "run": run.pk, "command": command}


def _answer(rows: list[Utterance], run: TrainingRun, parser: Parser, progress: Progress) -> None:
    """Replace what an earlier run answered to these utterances."""
    is_anonymous = run.train_sources == "gen"
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


def enqueue_doubts(world: World, rows: Sequence[Utterance], progress: Progress) -> int:
    """Queue those of ``rows`` that the parser is least sure of, or for which it and the nearest utterance give
    different forms. Returns how many items are new.

    Comparing takes minutes where there are thousands, and nobody waits for it: only what came of it is
    written, batch by batch.
    """
    tops = [
        top
        for some in batches(rows)
        for top in Proposal.objects.filter(utterance__in=some, rank=1).select_related("utterance")
    ]
    best = sorted(tops, key=lambda top: top.score)
    disagreements = list(_disagreements(world, best, progress))
    new = _enqueue(world, WorkKind.DISAGREEMENT, disagreements, progress)
    unsure = [
        WantedItem(
            top.utterance,
            f"{title_of(top.source)} is less sure of its answer here than of most others.",
        )
        for top in best[: int(len(best) * UNSURE_SHARE)]
    ]
    return new + _enqueue(world, WorkKind.LOW_CONFIDENCE, unsure, progress)


def _enqueue(world: World, kind: WorkKind, wanted: Sequence[WantedItem], progress: Progress) -> int:
    """Add the items whose utterances nobody has labelled or deleted meanwhile."""
    new = 0
    for some in batches(wanted):
        with progress.writing():
            keys = [each.subject.pk for each in some]
            left = set(
                world.utterances.unlabelled().filter(pk__in=keys).values_list("pk", flat=True)
            )
            new += enqueue(world, kind, [each for each in some if each.subject.pk in left])
    return new


def _disagreements(
    world: World, tops: Sequence[Proposal], progress: Progress
) -> Iterator[WantedItem]:
    for number, top in enumerate(tops):
        progress.report(number / len(tops), "comparing with the nearest utterances")
        text = top.utterance.anonymized_text
        nearest = nearest_forms(world, text, 1)
        is_certain = bool(derived_forms(world, text, 1))  # a command of the grammar
        if nearest and nearest[0].form != top.form and not is_certain:
            reason = f"{title_of(top.source)} and the nearest utterance give different forms."
            yield WantedItem(top.utterance, reason)
