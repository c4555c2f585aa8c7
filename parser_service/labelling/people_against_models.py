"""Verbs: train a parser on people's paraphrases and on models', as many of each, and test both on people's."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from random import Random

from django.db import transaction
from django.db.models import Count

from annotations.generation.freezing import PreparedSplit, assign_parts, plan_split
from annotations.language.corpus import Criterion, Part
from annotations.language.texts import Refusal
from annotations.models import Example, Split, User, World
from annotations.models.campaigns import ContributorKind
from annotations.models.splits import Source
from parser_service.models import TrainingRun
from parser_service.models.evaluations import ShownScore, shown_scores
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry import entry
from parser_service.runs.run_requests import request
from parser_service.runs.starting import Answer, count_started, require_left

PEOPLE, MODELS = "para", "model"  # what the two runs are trained on
SOURCES = {PEOPLE: Source.PARAPHRASED, MODELS: Source.MODEL}
TESTED_ON = "para"
MOST_RUNS = 200  # the newest that pairs are looked for in
MOST_PAIRS = 20


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

    The split is by logical form, or by source command for a parser that never writes a form it has not seen. Its
    training part has the same forms of both, each as often (``matched``).

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
    examples = matched(plan_split(world, criterion))
    counts = Counter((each.source, each.part) for each in examples)
    of_train = {name: counts[source, Part.TRAIN] for name, source in SOURCES.items()}
    if not of_train[MODELS] or not of_train[PEOPLE] or not counts[Source.PARAPHRASED, Part.TEST]:
        raise Refusal(
            "Training needs accepted paraphrases of people and of a language model for the same forms, and testing "
            "others of people: "
            f"there are {of_train[PEOPLE]}, {of_train[MODELS]} and {counts[Source.PARAPHRASED, Part.TEST]}. "
            "Collect more in a campaign.",
            "too_few_paraphrases",
            HTTPStatus.CONFLICT,
        )
    split = _split_of(world, criterion, examples, by)
    with transaction.atomic():
        answers = [
            request(
                *(world, split, parser),
                protocol=Protocol.STRICT,
                train_sources=name,
                by=by,
            )
            for name in (PEOPLE, MODELS)
        ]
    count_started(by, len(answers))
    return answers


def _split_of(world: World, criterion: str, examples: list[Example], by: User) -> Split:
    """Return the split that has just these examples; a new one where there is none."""
    stem = f"people-models-{'form' if criterion == Criterion.LOGICAL_FORM else 'source'}"
    with PreparedSplit(stem, criterion, examples, 0) as prepared, transaction.atomic():
        World.objects.hold().get(pk=world.pk)
        same = world.splits.filter(content_hash=prepared.content_hash, criterion=criterion).first()
        if same is not None:
            return same
        names = set(world.splits.filter(name__startswith=stem).values_list("name", flat=True))
        prepared.name = next(
            name for number in range(1, len(names) + 2) if (name := f"{stem}-{number}") not in names
        )
        return prepared.store(world, by)[0]


def matched(examples: Sequence[Example]) -> list[Example]:
    """Return planned examples with as many training paraphrases of people as of models for each form.

    The others of the training part are left out, drawn by a fixed seed.
    """
    of_form: dict[tuple[str, str], list[Example]] = defaultdict(list)
    for each in examples:
        if each.part == Part.TRAIN and each.source in SOURCES.values():
            of_form[each.logical_form, each.source].append(each)
    left_out: set[int] = set()
    for form in sorted({form for form, _ in of_form}):
        fewest = min(len(of_form[form, source]) for source in SOURCES.values())
        for source in SOURCES.values():
            alike = sorted(of_form[form, source], key=lambda each: each.utterance)
            Random(f"{form}:{source}").shuffle(alike)
            left_out.update(id(each) for each in alike[fewest:])
    staying = [each for each in examples if id(each) not in left_out]
    return assign_parts(staying, [Part(each.part) for each in staying])


def run_pairs(world: World) -> list[RunPair]:
    """Return the runs of ``world`` that learned from as many paraphrases of people and of models for each form, the
    newest first."""
    runs = world.runs.scored_or_active().on_all_pairs().filter(train_sources__in=SOURCES)
    newest = list(
        runs.select_related("split").prefetch_related("evaluations").order_by("-id")[:MOST_RUNS]
    )
    comparable = _matched_splits({run.split_id for run in newest})
    grouped: dict[tuple[object, ...], dict[str, TrainingRun]] = defaultdict(dict)
    for run in newest:
        if run.split_id in comparable:
            alike = (run.split_id, run.parser, run.parser_version, run.protocol, run.seed)
            grouped[*alike, run.changed_hyperparameters()].setdefault(run.train_sources, run)
    both = (each for each in grouped.values() if len(each) == len(SOURCES))
    return [RunPair(each[PEOPLE], each[MODELS]) for each in both][:MOST_PAIRS]


def _matched_splits(splits: Iterable[int]) -> set[int]:
    """Return the keys of the splits that train on as many paraphrases of people as of models for each form."""
    rows = Example.objects.filter(split__in=splits, part=Part.TRAIN, source__in=SOURCES.values())
    grouped = rows.order_by().values_list("split", "logical_form", "source").annotate(Count("pk"))
    counts: dict[int, dict[str, Counter[str]]] = defaultdict(lambda: defaultdict(Counter))
    for key, form, source, count in grouped:
        counts[key][form][source] = count
    return {
        key
        for key, forms in counts.items()
        if all(len({each[source] for source in SOURCES.values()}) == 1 for each in forms.values())
    }


def has_both(world: World) -> bool:
    """Return whether people and models have accepted paraphrases in ``world``."""
    accepted = world.paraphrases.accepted()
    by_models = accepted.filter(contributor__kind=ContributorKind.MODEL)
    by_people = accepted.exclude(contributor__kind=ContributorKind.MODEL)
    return by_models.exists() and by_people.exists()
