"""The accuracy tables as files: what the page shows, one figure a row, and in LaTeX as the page has it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from enum import StrEnum
from typing import Any

from annotations.exchange.tables import table_pieces
from annotations.models import World
from parser_service.models.evaluations import KNOWN_FORMS, UNSEEN
from parser_service.results.answerer_rows import answerer_tables, as_row
from parser_service.results.latex import as_latex
from parser_service.results.result_choices import ResultsChoices
from parser_service.results.seed_figures import AccuracyFigure
from parser_service.results.table_parts import AccuracyTable, may_know_corpora

# Of the newest run of a cell.
SCORE_TYPES = {
    "part": "string",
    "run_id": "int64",
    "count": "int64",
    "correct": "int64",
    **dict.fromkeys(("accuracy", "interval_low", "interval_high"), "double"),
    **dict.fromkeys(("equivalent", "well_formed"), "double"),
}
# Exact match over all seeds of a cell.
SEED_TYPES = {"mean": "double", "spread": "double", "n_seeds": "int64"}
# By form, what the figure is the mean of, each with the ends of its interval.
PART_FIELDS = [f"{part}{end}" for part in (UNSEEN, KNOWN_FORMS) for end in ("", "_low", "_high")]
# The columns, in this order in every release, with their types in Parquet.
COLUMNS = {
    **dict.fromkeys(("parser", "configuration", "protocol"), "string"),
    **dict.fromkeys(("train_sources", "test_source", "split", "criterion"), "string"),
    **SCORE_TYPES,
    **SEED_TYPES,
    "measure": "string",
    # The figure that the page shows, in percent; by form a harmonic mean.
    **dict.fromkeys(("percent", "plus_minus", "low", "high"), "double"),
    "is_best": "bool",
    "published": "double",
    # The model that answered, as its server reports it, and whether it may have read a public corpus.
    "answered_by": "string",
    "may_know_corpora": "bool",
    **dict.fromkeys(PART_FIELDS, "double"),
    "same_plan": "double",  # of the newest run too; empty where plans were not compared
}


class ResultsFormat(StrEnum):
    JSON = "json"
    CSV = "csv"
    PARQUET = "parquet"
    TEX = "tex"


def export_results(world: World, choices: ResultsChoices, as_: str) -> Iterator[bytes]:
    """Return the accuracy tables that ``choices`` show as a file in pieces; ``as_`` is a ``ResultsFormat``."""
    match ResultsFormat(as_):
        case ResultsFormat.JSON:
            shown = json.dumps(as_json(world, choices), indent=1, ensure_ascii=False)
            return iter([shown.encode()])
        case ResultsFormat.TEX:
            return iter([as_latex(choices, choices.tables(world)).encode()])
    rows = (tuple(row.values()) for row in rows_of(choices.tables(world)))
    return table_pieces(rows, [*COLUMNS], as_, COLUMNS, _chosen(world, choices))


def rows_of(tables: Iterable[AccuracyTable]) -> Iterator[dict[str, Any]]:
    """Yield one row per figure of a scored cell; accuracies are fractions of 1.

    What the newest run scored comes first, then mean and spread of exact match (the sample standard
    deviation, None for one run) over all seeds, then the figure as the page shows it, in percent, with
    how far its 95 % interval reaches (``plus_minus``). A figure that is not known has its measure alone.
    """
    for table in tables:
        for row, cells in table.filled:
            for column, cell in cells:
                if cell and cell.score:
                    for measure, figure in cell.by_measure:
                        yield {
                            **dict.fromkeys(COLUMNS),
                            "parser": row.parser,
                            "configuration": json.dumps(dict(row.changes)),
                            "protocol": table.protocol,
                            "train_sources": column.train_sources,
                            "test_source": column.test_source,
                            "split": column.split.name,
                            "criterion": column.split.criterion,
                            **{name: getattr(cell.score, name) for name in SCORE_TYPES},
                            **{name: getattr(cell.over_seeds, name) for name in SEED_TYPES},
                            "measure": measure,
                            **(_values(figure) if figure else {}),
                            "answered_by": cell.answered_by,
                            "may_know_corpora": may_know_corpora(row.parser),
                            "same_plan": cell.score.same_plan,
                        }


def as_json(world: World, choices: ResultsChoices) -> dict[str, Any]:
    """Return the choices of the page, the rows of ``rows_of``, and what a robot gets from the answerer of the
    world by source."""
    measured = answerer_tables(world, choices.splits, choices.part)
    return {
        **_chosen(world, choices),
        "figures": list(rows_of(choices.tables(world))),
        "answerer": [as_row(each.row) for table in measured for each in table.rows],
    }


def _chosen(world: World, choices: ResultsChoices) -> dict[str, Any]:
    return {
        "world": world.name,
        "part": choices.part,
        "splits": [split.name for split in choices.splits],
        "measures": list(choices.measures),
        "published": choices.published,
    }


def _values(figure: AccuracyFigure) -> dict[str, Any]:
    """Return what a row has of a figure; on unseen forms alone it is also that of unseen forms."""
    parts = {part.label: part for part in figure.parts} | ({UNSEEN: figure} if figure.alone else {})
    values = {
        "percent": figure.percent,
        "plus_minus": figure.reach,
        "low": figure.low,
        "high": figure.high,
        "is_best": figure.is_best,
        "published": figure.published,
    }
    for label, part in parts.items():
        values |= {label: part.percent, f"{label}_low": part.low, f"{label}_high": part.high}
    return values
