"""Verbs: train a parser on people's paraphrases and on models', as many of each, and test both on people's."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from http import HTTPStatus

from django.db import transaction
from django.db.models import Count

from annotations.language.corpus import Criterion, Part
from annotations.language.errors import Refusal
from annotations.models import Example, Split, User, World
from annotations.models.campaigns import ContributorKind
from annotations.models.splits import Source
from annotations.splits.freezing import PreparedSplit, plan_split
from parser_service.models import TrainingRun
from parser_service.models.evaluations import ShownScore, shown_scores
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry import entry
from parser_service.runs.requests.run_requests import LEAST_SHARE, request
from parser_service.runs.requests.starting import Answer, count_started, require_left

PEOPLE, MODELS = "para", "model"  # what the two runs are trained on
SOURCES = {PEOPLE: Source.PARAPHRASED, MODELS: Source.MODEL}
TESTED_ON = "para"
MOST_RUNS = 200  # the newest that pairs are looked for in
MOST_PAIRS = 20
_DIGITS = 4  # of a share


@dataclass(frozen=True, slots=True)
class RunPair:
    """Two runs of one split that differ in whose paraphrases they learned from, as many of each."""

    people: TrainingRun
    models: TrainingRun

    @property
    def sides(self) -> list[tuple[TrainingRun, ShownScore | None]]:
        """Each run with its score on people's paraphrases of the test part; None before it has one."""
        return [(run, score_of(run)) for run in (self.people, self.models)]

    @property
    def is_active(self) -> bool:
        """Whether one of them waits or runs."""
        return not (self.people.is_ended and self.models.is_ended)

    @property
    def are_scored(self) -> bool:
        return all(score is not None for _, score in self.sides)


def score_of(run: TrainingRun) -> ShownScore | None:
    shown = shown_scores(run.evaluations.all(), run.split.criterion)
    return shown.get((Part.TEST, TESTED_ON))


def start_people_against_models(world: World, parser: str, by: User) -> list[Answer]:
    """Freeze a split of today, unless there is one, and request a run on people's paraphrases and one on models'.

    The split is by logical form, or by source command for a parser that never writes a form it has not seen.

    Returns:
        What ``request`` returns, for people and for models.

    Raises:
        LanguageError: there is nothing to split.
        TooMany: somebody has started too many runs within the hour.
        Refusal: paraphrases of people or of models are missing, or as ``request``.
    """
    chosen = entry(parser)
    require_left(by, 2)
    criterion = Criterion.LOGICAL_FORM if chosen.writes_new_forms else Criterion.SOURCE_COMMAND
    examples = plan_split(world, criterion)
    counts = Counter((each.source, each.part) for each in examples)
    of_train = {name: counts[source, Part.TRAIN] for name, source in SOURCES.items()}
    if not of_train[MODELS] or not of_train[PEOPLE] or not counts[Source.PARAPHRASED, Part.TEST]:
        raise Refusal(
            "Training needs accepted paraphrases of people and of a language model, and testing others of people: "
            f"there are {of_train[PEOPLE]}, {of_train[MODELS]} and {counts[Source.PARAPHRASED, Part.TEST]}. "
            "Collect more in a campaign.",
            "too_few_paraphrases",
            HTTPStatus.CONFLICT,
        )
    split = _split_of(world, criterion, examples, by)
    shares = equal_shares(of_train)
    with transaction.atomic():
        answers = [
            request(
                *(world, split, parser),
                protocol=Protocol.STRICT,
                train_sources=name,
                by=by,
                train_share=shares[name],
            )
            for name in (PEOPLE, MODELS)
        ]
    count_started(by, len(answers))
    return answers


def _split_of(world: World, criterion: str, examples: list[Example], by: User) -> Split:
    """Return the split that has just these examples; a new one where there is none."""
    stem = f"people-models-{'form' if criterion == Criterion.LOGICAL_FORM else 'source'}"
    with PreparedSplit(stem, criterion, examples, 0) as prepared, transaction.atomic():
        World.objects.select_for_update().get(pk=world.pk)
        same = world.splits.filter(content_hash=prepared.content_hash, criterion=criterion).first()
        if same is not None:
            return same
        names = set(world.splits.filter(name__startswith=stem).values_list("name", flat=True))
        prepared.name = next(
            name for number in range(1, len(names) + 2) if (name := f"{stem}-{number}") not in names
        )
        return prepared.store(world, by)[0]


def equal_shares(pairs: Mapping[str, int]) -> dict[str, float]:
    """Return which share of each number of pairs gives as many as the smallest of them."""
    fewest = min(pairs.values())
    scale = 10**_DIGITS
    return {
        name: max(LEAST_SHARE, math.ceil(scale * fewest / count) / scale)
        for name, count in pairs.items()
    }


def run_pairs(world: World) -> list[RunPair]:
    """Return the runs of ``world`` that learned from as many paraphrases of people and of models, the newest first."""
    runs = world.runs.scored_or_active().filter(train_sources__in=SOURCES)
    newest = list(
        runs.select_related("split").prefetch_related("evaluations").order_by("-id")[:MOST_RUNS]
    )
    shares = _shares_of({run.split_id for run in newest})
    grouped: dict[tuple[object, ...], dict[str, TrainingRun]] = defaultdict(dict)
    for run in newest:
        if run.train_share == shares.get(run.split_id, {}).get(run.train_sources):
            alike = (run.split_id, run.parser, run.parser_version, run.protocol, run.seed)
            grouped[*alike, run.changed_hyperparameters()].setdefault(run.train_sources, run)
    both = (each for each in grouped.values() if len(each) == len(SOURCES))
    return [RunPair(each[PEOPLE], each[MODELS]) for each in both][:MOST_PAIRS]


def _shares_of(splits: Iterable[int]) -> dict[int, dict[str, float]]:
    """Return key of a split → the shares with which its runs learn from as many pairs; both sources are there."""
    rows = Example.objects.filter(split__in=splits, part=Part.TRAIN, source__in=SOURCES.values())
    grouped = rows.order_by().values_list("split", "source").annotate(Count("pk"))
    counts: dict[int, dict[str, int]] = defaultdict(dict)
    names = {source.value: name for name, source in SOURCES.items()}
    for key, source, count in grouped:
        counts[key][names[source]] = count
    return {key: equal_shares(each) for key, each in counts.items() if len(each) == len(SOURCES)}


def has_both(world: World) -> bool:
    """Return whether people and models have accepted paraphrases in ``world``."""
    accepted = world.paraphrases.accepted()
    by_models = accepted.filter(contributor__kind=ContributorKind.MODEL)
    by_people = accepted.exclude(contributor__kind=ContributorKind.MODEL)
    return by_models.exists() and by_people.exists()
