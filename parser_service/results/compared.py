"""Runs of one split beside each other, on the examples of a part that a slice chooses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from annotations.language.corpus import Criterion
from annotations.models import World
from parser_service.analysis.answer_forms import NO_FORM
from parser_service.analysis.arrays import Bools, Ints
from parser_service.analysis.comparing import RunComparison, compare_runs, count_wins
from parser_service.analysis.confusions import HeadConfusion, confuse_heads
from parser_service.analysis.encoded_labels import EncodedLabels
from parser_service.analysis.intervals import SAMPLES
from parser_service.analysis.slicing import SliceAccuracies, accuracy_where
from parser_service.models import TrainingRun
from parser_service.results.filter_conditions import FilterCondition, NoColumn
from parser_service.results.measures import Measure
from parser_service.results.prediction_filters import PredictionFilters
from parser_service.results.stored_columns import (
    UNKNOWN_COUNT,
    ExampleArrays,
    answers_of,
    examples_of,
)


@dataclass(frozen=True, eq=False)
class Compared:
    """``runs`` share a split. ``answers`` are their columns, and ``chosen`` [examples] says which examples are
    counted: those of the slice that every run has an answer stored for.

    What a filter says of answers (outcome, category, form in training) is meant of the first run. ``measure`` says
    which answers are right.
    """

    world: World
    runs: tuple[TrainingRun, ...]
    part: str
    examples: ExampleArrays
    answers: tuple[Mapping[str, Any], ...]
    chosen: Bools
    measure: Measure = Measure.EXACT

    @property
    def base(self) -> TrainingRun:
        return self.runs[0]

    @cached_property
    def count(self) -> int:
        return int(np.count_nonzero(self.chosen))

    @cached_property
    def correct(self) -> Bools:
        """Whether each run is right on each chosen example, [runs, chosen]."""
        is_right = self.measure.column
        return np.array([columns[is_right][self.chosen] == 1 for columns in self.answers])

    @cached_property
    def without_plans(self) -> list[TrainingRun]:
        """The runs with a chosen answer whose plan was not compared."""
        plans = (columns["is_same_plan"][self.chosen] for columns in self.answers)
        return [
            run for run, of in zip(self.runs, plans, strict=True) if (of == UNKNOWN_COUNT).any()
        ]

    @cached_property
    def clusters(self) -> Ints:
        """The cluster of each chosen example, without those that have none, [chosen]."""
        _, clusters = np.unique(self.column("cluster"), return_inverse=True)
        return clusters.astype(np.int64)

    @property
    def clusters_in_words(self) -> str:
        """What is drawn as a whole."""
        is_by_form = self.base.split.criterion == Criterion.LOGICAL_FORM
        return "logical forms" if is_by_form else "source commands"

    @cached_property
    def accuracies(self) -> SliceAccuracies:
        """The accuracy of each run on the chosen examples: one slice."""
        everything = np.ones(self.count, dtype=bool)
        return accuracy_where(self.correct, everything, self.clusters, SAMPLES)

    @cached_property
    def wins(self) -> list[list[int]]:
        """On how many examples one run (row) is right and another (column) is wrong."""
        wins: list[list[int]] = count_wins(self.correct).tolist()
        return wins

    @cached_property
    def comparisons(self) -> tuple[RunComparison, ...]:
        """Every pair of runs; none without an example."""
        return compare_runs(self.correct, self.clusters) if self.count else ()

    def column(self, name: str, run: int = 0) -> Any:
        """Return a column of the examples, or of a run's answers, for the chosen examples."""
        values = self.examples.columns.get(name)
        values = self.answers[run][name] if values is None else values
        if isinstance(values, EncodedLabels):
            return EncodedLabels(values.values, values.codes[self.chosen])
        return values[self.chosen]

    def confusion(self, run: int) -> HeadConfusion:
        """Count the head predicates of the labels against those of a run's answers."""
        gold = self.column("head_predicate")
        named = EncodedLabels(tuple(value or NO_FORM for value in gold.values), gold.codes)
        return confuse_heads(named, self.column("answer_head", run))

    def mask(self, conditions: Sequence[FilterCondition]) -> Bools:
        """Return which chosen examples fulfil conditions, [chosen]."""
        mask = _mask(conditions, self.base, self.part, self.examples, self.answers[0])
        return mask[self.chosen]


def compare_on(
    world: World,
    runs: Sequence[TrainingRun],
    part: str,
    filters: PredictionFilters,
    measure: Measure = Measure.EXACT,
) -> Compared:
    """Compare runs of one split on a part, where ``filters`` (of which ``part`` is ignored) choose its examples.

    By same plan an answer whose plan was not compared is wrong: ``without_plans`` names the runs that have any.
    """
    filters.of_run = runs[0]
    examples = examples_of(runs[0].split, part)
    answers = tuple(answers_of(run, part, examples) for run in runs)
    chosen = np.logical_and.reduce([columns["is_there"] for columns in answers])
    chosen = chosen & _mask(filters.conditions(but=["part"]), runs[0], part, examples, answers[0])
    return Compared(world, tuple(runs), part, examples, answers, chosen, measure)


def are_in_columns(conditions: Sequence[FilterCondition], compared: Compared) -> bool:
    """Return whether columns alone tell which examples fulfil conditions, which takes no query."""
    columns = {**compared.examples.columns, **compared.answers[0]}
    try:
        for condition in conditions:
            condition.mask(columns)
    except NoColumn:
        return False
    return True


def _mask(
    conditions: Sequence[FilterCondition],
    run: TrainingRun,
    part: str,
    examples: ExampleArrays,
    answers: Mapping[str, Any],
) -> Bools:
    columns = {**examples.columns, **answers}
    mask = np.ones(len(examples.keys), dtype=bool)
    for condition in conditions:
        try:
            mask &= condition.mask(columns)
        except NoColumn:
            rows = run.predictions.best().filter(condition.rows, example__part=part).order_by()
            mask &= examples.mask_of_keys(list(rows.values_list("example_id", flat=True)))
    return mask
