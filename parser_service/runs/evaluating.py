"""A trained parser's predictions on the validation and test parts, and how often it is right."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from annotations.background import outlasting
from annotations.models import Example
from annotations.models.splits import Part
from parser_service.analysis.scores import NO_ANSWER, Score, judge, score
from parser_service.models import Evaluation, Prediction, TrainingRun
from parser_service.parsers.conditions import TEST_SOURCES
from parser_service.parsers.interface import TRAINING, Candidate, Pair, Parser
from parser_service.runs import lifecycle
from parser_service.runs.observing import RunObserver

BEAM_WIDTH = 5
AT_ONCE = 64
ROWS_AT_ONCE = 500
DECIMALS = 4  # of the parts of a score


def evaluate(
    run: TrainingRun,
    parser: Parser,
    train: Sequence[Pair],
    validation: Sequence[Pair],
    observe: RunObserver,
) -> None:
    """Predict every validation and test example of the run's split and store the outcomes.

    ``train`` are the pairs that the parser learned from, ``validation`` those that it may consult when
    the test part is scored. An earlier attempt's predictions are replaced. Raises Cancelled and Fenced.
    """
    predicted: list[tuple[Example, list[Candidate]]] = []
    parts = {Part.VALIDATION: parser, Part.TEST: parser.for_test_part(validation)}
    examples = {part: list(run.split.examples.filter(part=part)) for part in parts}
    total = sum(map(len, examples.values()))
    for part, answering in parts.items():
        for start in range(0, len(examples[part]), AT_ONCE):
            batch = examples[part][start : start + AT_ONCE]
            utterances = [example.utterance for example in batch]
            answers = answering.predict(utterances, BEAM_WIDTH, observe.check)
            predicted += zip(batch, answers, strict=True)
            observe.evaluation_progress(len(predicted) / total, f"predicting the {part} part")
    counts = Counter(pair.form for pair in train)
    ranked = [_rank_answers(run, example, answers, counts) for example, answers in predicted]
    _store(run, ranked, score_kind=parser.score_kind or "", train_pairs=len(train))


@outlasting
def _store(run: TrainingRun, ranked: Sequence[Sequence[Prediction]], **about: str | int) -> None:
    """Replace the run's predictions, one list for each example, and its evaluations, and store in the
    run what is ``about`` them."""
    with lifecycle.held(run):
        TrainingRun.objects.filter(pk=run.pk).update(**about)
        run.predictions.all().delete()
        run.evaluations.all().delete()
        rows = [row for rows in ranked for row in rows]
        Prediction.objects.bulk_create(rows, batch_size=ROWS_AT_ONCE)
        Evaluation.objects.bulk_create(_make_evaluations(run, [rows[0] for rows in ranked]))


def _rank_answers(
    run: TrainingRun, example: Example, answers: Sequence[Candidate], counts: Mapping[str, int]
) -> list[Prediction]:
    """Return one row per candidate, best first; a single row without a form where there is none.

    ``counts`` says how many training pairs have a form.
    """
    return [
        _make_prediction(run, example, rank, answer, counts)
        for rank, answer in enumerate(answers or [Candidate("", 0.0)], start=1)
    ]


def _make_prediction(
    run: TrainingRun, example: Example, rank: int, answer: Candidate, counts: Mapping[str, int]
) -> Prediction:
    judgement = judge(answer.form, example.logical_form) if answer.form else NO_ANSWER
    return Prediction(
        run=run,
        example=example,
        rank=rank,
        logical_form=answer.form,
        score=answer.score,
        is_exact_match=judgement.is_exact_match,
        is_equivalent=judgement.is_equivalent,
        is_well_formed=judgement.is_well_formed,
        answer_in_training=counts.get(answer.form, 0) if answer.form else None,
        label_in_training=counts.get(example.logical_form, 0),
        origin=answer.origin or (TRAINING if answer.form in counts else ""),
        score_parts={name: round(value, DECIMALS) for name, value in answer.parts.items()},
    )


def _make_evaluations(run: TrainingRun, best: Sequence[Prediction]) -> list[Evaluation]:
    """Return one row per part and test source with examples; ``mixed`` where both sources have some."""
    evaluations = []
    for part in (Part.VALIDATION, Part.TEST):
        of_part = [row for row in best if row.example.part == part]
        sources_there = {row.example.source for row in of_part}
        for name, sources in TEST_SOURCES.items():
            if sources_there.issuperset(sources):
                chosen = [row for row in of_part if row.example.source in sources]
                evaluations.append(_make_evaluation(run, part, name, score(chosen)))
    return evaluations


def _make_evaluation(run: TrainingRun, part: str, test_source: str, result: Score) -> Evaluation:
    return Evaluation(
        run=run,
        test_source=test_source,
        part=part,
        count=result.count,
        correct=result.correct,
        accuracy=result.accuracy,
        interval_low=result.interval[0],
        interval_high=result.interval[1],
        equivalent=result.equivalent,
        well_formed=result.well_formed,
    )
