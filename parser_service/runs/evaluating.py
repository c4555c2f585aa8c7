"""A trained parser's predictions on the validation and test parts, and how often it is right."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from annotations.background import outlasting
from annotations.language.corpus import KNOWN, Part
from annotations.language.texts import normalise
from annotations.models import Example
from annotations.rows.synchronise import BATCH, batches
from parser_service.analysis.outcomes import interval_of_outcomes, outcomes_of
from parser_service.analysis.scores import SamePlan, judge, score
from parser_service.models import Evaluation, Prediction, TrainingRun
from parser_service.parsers.conditions import TEST_SOURCES, sources_of
from parser_service.parsers.interface import TRAINING, Candidate, Pair, Parser
from parser_service.runs import lifecycle
from parser_service.runs.cross_fitting import calibrated_folds
from parser_service.runs.knowledge import plan_agreement_of
from parser_service.runs.observing import RunObserver
from parser_service.runs.split_pairs import as_pairs, cluster_of

BEAM_WIDTH = 5
AT_ONCE = 64
ASKED_AT_ONCE = 8  # where each answer may take seconds: progress is told after each batch
DECIMALS = 4  # of the parts of a score
NO_CANDIDATE = Candidate("", 0.0)  # a row without a form, where the parser gives none


def evaluate(
    run: TrainingRun,
    parser: Parser,
    train: Sequence[Pair],
    validation: Sequence[Pair],
    observe: RunObserver,
    known: Sequence[Example] = (),
) -> None:
    """Predict every validation and test example of the run's split and store the outcomes.

    The validation part is cross-fitted: nothing is answered by what its cluster calibrated.

    Args:
        train: the pairs that the parser learned from.
        validation: those that calibrated it, and that it may consult when the test part is scored.
        known: examples held out of the training part. Those whose form is in ``train`` are scored, as
            the part ``known``, and no answer to them is kept.

    An earlier attempt's predictions are replaced. Raises Cancelled and Fenced.
    """
    forms = Counter(pair.form for pair in train)
    known_forms = [example for example in known if example.logical_form in forms]
    asked = [*_asked(run, parser, validation), AskedPart(KNOWN, parser, known_forms)]
    total = sum(len(batch.examples) for batch in asked)
    size = ASKED_AT_ONCE if parser.asks_a_server else AT_ONCE
    predicted: list[tuple[str, Example, list[Candidate]]] = []
    for batch in asked:
        for start in range(0, len(batch.examples), size):
            examples = batch.examples[start : start + size]
            utterances = [normalise(example.utterance) for example in examples]
            answers = batch.parser.predict(utterances, BEAM_WIDTH, observe.check)
            predicted += [(batch.part, *each) for each in zip(examples, answers, strict=True)]
            observe.evaluation_progress(len(predicted) / total, f"predicting the {batch.part} part")
    cut = [example for _, example, answers in predicted if any(each.is_cut for each in answers)]
    if cut:
        observe.log(
            f"{len(cut):,} of {len(predicted):,} utterances are longer than the parser reads; it read the "
            f'beginning of each, first of "{cut[0].utterance[:60]}…".'
        )
    same_plan = plan_agreement_of(run.world)
    ranked = [
        (
            part,
            [
                _make_prediction(run, example, rank, answer, forms, same_plan)
                for rank, answer in enumerate(answers or [NO_CANDIDATE], start=1)
            ],
        )
        for part, example, answers in predicted
    ]
    about = {"score_kind": parser.score_kind or "", "answered_by": parser.answered_by}
    _store(run, ranked, train_pairs=len(train), **about)


class AskedPart(NamedTuple):
    """Examples of one part, and the parser that answers them."""

    part: str
    parser: Parser
    examples: Sequence[Example]


def _asked(run: TrainingRun, parser: Parser, validation: Sequence[Pair]) -> Iterator[AskedPart]:
    """Yield the examples of the validation part, in folds, and those of the test part."""
    examples = list(run.split.examples.filter(part=Part.VALIDATION))
    clusters = [cluster_of(each, run.split.criterion) for each in examples]
    sources = sources_of(run.train_sources)
    calibrating = [at for at, example in enumerate(examples) if example.source in sources]
    folds = calibrated_folds(
        parser,
        clusters,
        as_pairs(examples[at] for at in calibrating),
        [clusters[at] for at in calibrating],
    )
    for of_fold, places in folds:
        yield AskedPart(Part.VALIDATION, of_fold, [examples[at] for at in places])
    test = list(run.split.examples.filter(part=Part.TEST))
    yield AskedPart(Part.TEST, parser.for_test_part(validation), test)


def _store(
    run: TrainingRun, ranked: Sequence[tuple[str, Sequence[Prediction]]], **about: str | int
) -> None:
    """Replace the run's predictions and its evaluations, and store in the run what is ``about`` them.

    Predictions are written in short transactions, between which others write. The evaluations come
    last: where there are some, all predictions are there.

    ``ranked`` has for each example its part and its predictions; those of known forms are only counted.
    """
    best = [(part, rows[0]) for part, rows in ranked]
    evaluations = _make_evaluations(run, best)
    _remove_earlier(run)
    for some in batches(row for part, rows in ranked if part != KNOWN for row in rows):
        _add(run, some)
    _conclude(run, evaluations, about)


@outlasting
def _remove_earlier(run: TrainingRun) -> None:
    with lifecycle.held(run):
        run.evaluations.all().delete()
    while keys := list(run.predictions.order_by().values_list("pk", flat=True)[:BATCH]):
        with lifecycle.held(run):
            Prediction.objects.filter(pk__in=keys).delete()


@outlasting
def _add(run: TrainingRun, rows: Sequence[Prediction]) -> None:
    with lifecycle.held(run):
        # Repeated after an outage, some may be there already.
        Prediction.objects.bulk_create(rows, ignore_conflicts=True)


@outlasting
def _conclude(
    run: TrainingRun, evaluations: Sequence[Evaluation], about: Mapping[str, str | int]
) -> None:
    with lifecycle.held(run):
        TrainingRun.objects.filter(pk=run.pk).update(**about)
        run.evaluations.all().delete()
        Evaluation.objects.bulk_create(evaluations)


def _make_prediction(
    run: TrainingRun,
    example: Example,
    rank: int,
    answer: Candidate,
    counts: Mapping[str, int],
    same_plan: SamePlan,
) -> Prediction:
    judgement = judge(answer.form, example.logical_form, same_plan)
    return Prediction(
        run=run,
        example=example,
        rank=rank,
        logical_form=answer.form,
        score=answer.score,
        is_exact_match=judgement.is_exact_match,
        is_equivalent=judgement.is_equivalent,
        is_well_formed=judgement.is_well_formed,
        is_same_plan=judgement.is_same_plan,
        answer_in_training=counts.get(answer.form, 0) if answer.form else None,
        label_in_training=counts.get(example.logical_form, 0),
        origin=answer.origin or (TRAINING if answer.form in counts else ""),
        score_parts={name: round(value, DECIMALS) for name, value in answer.parts.items()},
        is_cut=answer.is_cut,
    )


def _make_evaluations(run: TrainingRun, best: Sequence[tuple[str, Prediction]]) -> list[Evaluation]:
    """Return one row per part and test source with examples; ``mixed`` where both sources have some."""
    evaluations = []
    for part in (Part.VALIDATION, Part.TEST, KNOWN):
        of_part = [row for of, row in best if of == part]
        sources_there = {row.example.source for row in of_part}
        for name, sources in TEST_SOURCES.items():
            if sources_there.issuperset(sources):
                chosen = [row for row in of_part if row.example.source in sources]
                evaluations.append(_make_evaluation(run, part, name, chosen))
    return evaluations


def _make_evaluation(
    run: TrainingRun, part: str, test_source: str, best: Sequence[Prediction]
) -> Evaluation:
    result = score(best)
    criterion = run.split.criterion
    outcomes = outcomes_of([cluster_of(row.example, criterion) for row in best], best)
    low, high = interval_of_outcomes(outcomes) or result.interval
    return Evaluation(
        run=run,
        test_source=test_source,
        part=part,
        count=result.count,
        correct=result.correct,
        accuracy=result.accuracy,
        interval_low=low,
        interval_high=high,
        equivalent=result.equivalent,
        well_formed=result.well_formed,
        same_plan=result.same_plan,
        outcomes=outcomes,
    )
