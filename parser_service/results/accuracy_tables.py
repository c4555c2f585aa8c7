"""The accuracy tables of a world: one per protocol, parsers down, settings across.

A row is a parser with one configuration. A cell is over all seeds that have been scored under its
row and column: with the newest version of the parser among them, and of each seed the newest run.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from django.urls import reverse
from django.utils.http import urlencode

from annotations.language.corpus import KNOWN, Criterion
from annotations.models import Split, World
from parser_service.analysis.comparing import is_better
from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers.conditions import PAPERS_SETTINGS, SETTINGS, Protocol, only_source
from parser_service.parsers.registry import parsers
from parser_service.results.accuracy_cells import Cell, newest_of_each_seed
from parser_service.results.measures import Measure, count_of, is_known
from parser_service.results.published import published_accuracy, published_criteria
from parser_service.results.seed_figures import AccuracyFigure, figure_of
from parser_service.results.table_parts import (
    SHORT_CRITERIA,
    AccuracyTable,
    Changes,
    TableColumn,
    TableRow,
)

Scores: TypeAlias = dict[tuple[int, str], Evaluation]


def accuracy_tables(
    world: World,
    part: str,
    splits: Iterable[Split],
    measures: tuple[Measure, ...] = (Measure.EXACT,),
    with_published: bool = False,
) -> list[AccuracyTable]:
    """Return the tables of ``world`` over ``splits`` for one ``part``. Three queries.

    Runs on a share of the training pairs are left out (``learning_curves``).
    """
    splits = sorted(splits, key=lambda split: split.pk)
    runs = list(
        world.runs.filter(split__in=splits).scored_or_active().on_all_pairs().order_by("-id")
    )
    scores = Evaluation.objects.filter(run__in=runs, part__in=[part, KNOWN])
    maker = TableMaker(
        world=world,
        part=part,
        columns=tuple(columns_of(runs, splits, scores)),
        scores=by_part(scores, part),
        known=by_part(scores, KNOWN),
        published=published_criteria(splits),
        measures=measures,
        with_published=with_published,
    )
    tables = (maker.table(protocol, runs) for protocol in Protocol)
    return [table for table in tables if table.rows]


def columns_of(
    runs: Iterable[TrainingRun], splits: list[Split], scores: Iterable[Evaluation]
) -> Iterator[TableColumn]:
    """Yield a column for each setting and split with a run, in the order of the paper; those that it lacks only
    where something is scored."""
    splits_of = {run.pk: run.split_id for run in runs}
    trained = {(run.train_sources, run.split_id) for run in runs}
    tested = {(each.test_source, splits_of[each.run_id]) for each in scores}
    is_telling = len({split.criterion for split in splits}) == len(splits)
    for train_sources, test_source in SETTINGS:
        is_papers = (train_sources, test_source) in PAPERS_SETTINGS
        shown = [
            split
            for split in splits
            if (train_sources, split.pk) in trained
            and (is_papers or (test_source, split.pk) in tested)
        ]
        for split in shown:
            label = SHORT_CRITERIA[Criterion(split.criterion)] if is_telling else split.name
            yield TableColumn(
                train_sources, test_source, split, label, starts_group=split is shown[0]
            )


@dataclass(frozen=True, slots=True)
class TableMaker:
    """Sorts runs, newest first, into tables.

    ``scores`` are by run and test source, ``known`` those on the known forms of splits by form;
    ``published`` says which split is which published one.
    Figures are by ``measures``; that of exact match has the published one beside it where it is wanted.
    """

    world: World
    part: str
    columns: tuple[TableColumn, ...]
    scores: Scores
    published: dict[int, str]
    known: Scores = field(default_factory=dict)
    measures: tuple[Measure, ...] = (Measure.EXACT,)
    with_published: bool = False

    def table(self, protocol: str, runs: list[TrainingRun]) -> AccuracyTable:
        grouped = defaultdict(list)
        for run in runs:
            if run.protocol == protocol:
                grouped[run.parser, run.changed_hyperparameters()].append(run)
        ranked = sorted(grouped.items(), key=lambda item: rank_of(*item[0]))
        rows = [self.row(parser, changes, mine) for (parser, changes), mine in ranked]
        best = [_best(cells) for cells in zip(*(row.cells for row in rows), strict=True)]
        marked = []
        for number, row in enumerate(rows):
            cells = (
                cell and cell.mark_best({at for at, of in enumerate(column) if of == number})
                for cell, column in zip(row.cells, best, strict=True)
            )
            marked.append(replace(row, cells=tuple(cells)))
        return AccuracyTable(protocol, self.columns, tuple(marked), self.measures)

    def row(self, parser: str, changes: Changes, runs: list[TrainingRun]) -> TableRow:
        cells = tuple(self.cell(parser, column, runs) for column in self.columns)
        return TableRow(parser, changes, cells)

    def cell(self, parser: str, column: TableColumn, runs: list[TrainingRun]) -> Cell | None:
        mine = [run for run in runs if column.shows(run)]
        scored = [run for run in mine if (run.pk, column.test_source) in self.scores]
        counted = newest_of_each_seed(scored)
        active = tuple(run for run in mine if not run.is_ended)
        if not counted and not active:
            return None
        scores = tuple(self.scores[run.pk, column.test_source] for run in counted)
        published = self.published_figure(parser, column)
        known = self.known_scores(counted, column)
        figures = self.figures(scores, published, known) if scores else ()
        names = dict.fromkeys(run.answered_by for run in counted if run.answered_by)
        address = self.cell_url(counted, active, column)
        by = ", ".join(names)
        return Cell(scores, active, published, address, figures, by, self.measures)

    def known_scores(
        self, counted: list[TrainingRun], column: TableColumn
    ) -> tuple[Evaluation, ...] | None:
        """Return the scores on known forms; none where one of the runs has none, None unless by form."""
        if column.split.criterion != Criterion.LOGICAL_FORM:
            return None
        known = [self.known.get((run.pk, column.test_source)) for run in counted]
        scores = tuple(score for score in known if score is not None)
        return scores if len(scores) == len(counted) else ()

    def figures(
        self,
        scores: tuple[Evaluation, ...],
        published: float | None,
        known: tuple[Evaluation, ...] | None = None,
    ) -> tuple[AccuracyFigure | None, ...]:
        """Return the figures over ``scores``, one by each measure; None where one of them is not known."""
        beside = {Measure.EXACT: published} if self.with_published else {}
        return tuple(
            figure_of(scores, each, beside.get(each), known_by(known, each))
            if all(is_known(score, each) for score in scores)
            else None
            for each in self.measures
        )

    def cell_url(
        self, counted: list[TrainingRun], active: tuple[TrainingRun, ...], column: TableColumn
    ) -> str:
        """Return the address of a single score's wrong answers, of a run to come, or of the list of seeds."""
        among = counted or active
        if len(among) > 1:
            return seeds_url(self.world, among[0])
        if not counted:
            return self.url("run", among[0].pk)
        score = self.scores[among[0].pk, column.test_source]
        return self.predictions_url(among[0], column, self.wrong_outcome(score))

    def wrong_outcome(self, score: Evaluation) -> str:
        """Return what the answers that the first figure counts as wrong are called; empty where there are none."""
        by_plan = self.measures[0] is Measure.SAME_PLAN and is_known(score, Measure.SAME_PLAN)
        measure = Measure.SAME_PLAN if by_plan else Measure.EXACT
        return measure.outcomes[1] if count_of(score, measure) < score.count else ""

    def published_figure(self, parser: str, column: TableColumn) -> float | None:
        criterion = self.published.get(column.split.pk, "")
        return published_accuracy(parser, column.setting, criterion)

    def predictions_url(self, run: TrainingRun, column: TableColumn, outcome: str) -> str:
        """Return the address of the predictions that a score of ``run`` counts: the wrong ones one by one
        for review, or the list of all."""
        chosen = {"part": self.part}
        if outcome:
            chosen["outcome"] = outcome
        if source := only_source(column.test_source):
            chosen["source"] = source
        if outcome:
            address = reverse("review", kwargs={"world": self.world.name})
            return f"{address}?{urlencode({'run': str(run.pk), **chosen})}"
        return f"{self.url('predictions', run.pk)}?{urlencode(chosen)}"

    def url(self, name: str, key: int) -> str:
        return reverse(name, kwargs={"world": self.world.name, "pk": key})


def known_by(
    known: tuple[Evaluation, ...] | None, measure: Measure
) -> tuple[Evaluation, ...] | None:
    """Return the scores on known forms; none where one of them is not known by ``measure``: no answers to known
    forms are kept, so that their plans cannot be compared later."""
    return () if known and not all(is_known(score, measure) for score in known) else known


def seeds_url(world: World, run: TrainingRun) -> str:
    """Return the address of the list of ``run`` and those that differ from it only by their seed."""
    return f"{reverse('runs', kwargs={'world': world.name})}?seeds_of={run.pk}"


def rank_of(parser: str, changes: Changes) -> tuple[int, int, str]:
    """Return a sort key: the order of the registry, defaults before changed hyperparameters."""
    names = list(parsers())
    place = names.index(parser) if parser in names else len(names)
    return place, len(changes), str(changes)


def by_part(scores: Iterable[Evaluation], part: str) -> Scores:
    """Return the scores on one part by run and test source."""
    return {(each.run_id, each.test_source): each for each in scores if each.part == part}


def _best(cells: Sequence[Cell | None]) -> list[int | None]:
    """Return by each measure the place of the cell that is better than all others of a column; None where
    the difference may be chance, and where one is not known or was not counted by cluster."""
    scored = [(at, cell.figures) for at, cell in enumerate(cells) if cell and cell.figures]
    if not scored:
        return []
    places = [at for at, _ in scored]
    winners: list[int | None] = []
    for of_measure in zip(*(figures for _, figures in scored), strict=True):
        figures = [figure for figure in of_measure if figure is not None]
        if len(figures) < len(of_measure):
            winners.append(None)
            continue
        ranked = sorted(zip(places, figures, strict=True), key=lambda pair: -pair[1].percent)
        counted = [figure.counted for _, figure in ranked]
        if {len(each) if each else 0 for each in counted} in ({1}, {2}):
            best, *others = [each for each in counted if each is not None]
            winners.append(ranked[0][0] if is_better(best, others) else None)
        else:
            winners.append(None)
    return winners
