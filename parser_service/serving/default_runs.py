"""Which run of a world to ask, and which ones a page opens on, where nobody names one.

One order says it all: ``Standing`` has the runs of one split, the surest to be right first.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from http import HTTPStatus

from django.db.models import Count, QuerySet

from annotations.language.corpus import KNOWN, Criterion, Part, harmonic_mean
from annotations.language.texts import Refusal
from annotations.models import Split, World
from annotations.models.background import Status
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.evaluations import ShownScore, shown_scores
from parser_service.parsers.registry import Needs, needing
from parser_service.runs.promoting import promoted_run

# What a person says is what counts; of runs that were never tested on it, the next best.
EVIDENCE = ("para", "said", "mixed", "gen", "model")

# Criteria under which a figure says how well known forms are answered, which is what most people ask for.
BY_COMMAND = (Criterion.COMMAND, Criterion.SOURCE_COMMAND)


@dataclass(frozen=True, slots=True)
class Standing:
    """Scores of the runs of ``split`` on its validation part, from ``source``: those of the run that is surest to be
    right first."""

    split: Split
    source: str
    scores: tuple[ShownScore, ...]

    @property
    def runs(self) -> list[TrainingRun]:
        return [each.score.run for each in self.scores]


def standings(world: World) -> Iterator[Standing]:
    """Yield the standings of ``world`` that say most about it, the best evidence first.

    Figures can be compared within one split alone. That is the one by command or source command with most runs that
    were tested on the source, of several the newest; where there is none, one by form. Runs on a share of the
    training pairs do not count.
    """
    rows = _tested().filter(run__world=world).order_by()
    counted = rows.values_list("test_source", "run__split__criterion", "run__split")
    ranked: dict[str, list[tuple[bool, int, int]]] = defaultdict(list)
    for source, criterion, split, runs in counted.annotate(Count("run", distinct=True)):
        ranked[source].append((criterion in BY_COMMAND, runs, split))
    for source in EVIDENCE:
        if ranked[source]:
            _, _, split = max(ranked[source])
            scores = _surest_first(split, source)
            yield Standing(scores[0].score.run.split, source, scores)


def best_run(world: World) -> TrainingRun:
    """Return the succeeded run of ``world`` that is surest to be right on validation paraphrases: the one
    with the highest lower end of the interval.

    Those that ask a server do not count: it is to hear only what somebody sends there. Where nothing was tested on
    paraphrases, generated commands decide. Raises Refusal where no run has succeeded.
    """
    asking = needing(Needs.SERVER)
    for standing in standings(world):
        for run in standing.runs:
            if run.parser not in asking:
                return run
    raise Refusal(
        f"No run of {world} has succeeded yet. Train a parser, then ask again.",
        "no_succeeded_run",
        HTTPStatus.CONFLICT,
    )


def answering_run(world: World) -> TrainingRun:
    """Return the run that answers in ``world`` where nobody names one: the promoted one, else ``best_run``.

    Raises Refusal where no run has succeeded.
    """
    return promoted_run(world) or best_run(world)


def opening_run(world: World) -> TrainingRun | None:
    """Return the run that a page opens on: ``answering_run``, else the newest that has succeeded; None where there is
    none."""
    try:
        return answering_run(world)
    except Refusal:
        return world.runs.succeeded().select_related("split").order_by("-pk").first()


def opening_split(world: World, splits: Sequence[Split], runs: Mapping[int, int]) -> Split | None:
    """Return the split of ``splits`` that a comparison of runs opens on: the one with most runs to compare.

    Of several that is the one of ``opening_run``, else the newest. ``runs`` counts them by the key of the split.
    """
    opening = opening_run(world)

    def rank(split: Split) -> tuple[int, bool, int]:
        is_opening = opening is not None and opening.split_id == split.pk
        return runs.get(split.pk, 0), is_opening, split.pk

    return max(splits, key=rank, default=None)


def best_two(split: Split, runs: Sequence[TrainingRun]) -> list[TrainingRun]:
    """Return the two of ``runs``, all of ``split``, that a comparison opens on, the surer first; none of one run.

    Runs that were not tested on the validation part come last, the newest of them first.
    """
    order: dict[int, int] = {}
    for source in EVIDENCE:
        for score in _surest_first(split.pk, source):
            order.setdefault(score.score.run_id, len(order))
    ranked = sorted(runs, key=lambda run: (order.get(run.pk, len(order)), -run.pk))
    return ranked[:2] if len(ranked) > 1 else []


def _tested() -> QuerySet[Evaluation]:
    return Evaluation.objects.filter(
        run__status=Status.SUCCEEDED, run__train_share=1, part=Part.VALIDATION, count__gt=0
    )


def _surest_first(split: int, source: str) -> tuple[ShownScore, ...]:
    """Return the scores on the validation part of a split, that with the highest lower end of its interval first.
    By form those on unseen forms alone come last."""
    of_runs: dict[int, list[Evaluation]] = defaultdict(list)
    tested = _tested().filter(run__split=split, test_source=source).values("run")
    rows = Evaluation.objects.filter(
        run__in=tested, test_source=source, part__in=(Part.VALIDATION, KNOWN)
    )
    for row in rows.select_related("run__split").order_by():
        of_runs[row.run_id].append(row)
    scores = [
        shown_scores(each, each[0].run.split.criterion)[Part.VALIDATION, source]
        for each in of_runs.values()
    ]
    return tuple(sorted(scores, key=_sureness, reverse=True))


def _sureness(shown: ShownScore) -> tuple[bool, float, float, int]:
    lower = shown.score.interval_low
    if shown.known is not None:
        lower = harmonic_mean(lower, shown.known.interval_low)
    return not shown.alone, lower, shown.accuracy, shown.score.run_id
