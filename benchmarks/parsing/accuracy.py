"""The paper's accuracy table, from the cells of ``manage.py benchmark``.

    .venv/bin/python -m benchmarks.parsing.accuracy cells.json [--markdown | --latex | --csv] [--part validation]

One table per protocol, with a row for each parser and a column for each setting and criterion. A figure is
exact match in percent, the mean over seeds. By form there are three: on unseen forms, on known ones, and the
harmonic mean of both, which is the headline. ± is how far the 95 % interval reaches: clusters (forms by
form, else source commands) and trainings are drawn with replacement. A figure is bold where it is better
than every other one of its column, by a paired bootstrap with Holm's correction. New splits are rows of
their own. The standard deviations between trainings stand in a second table. The paper's figure, always
on the test parts, is in parentheses. Where plans were compared, tables of the answers with the same plan follow.

``--csv`` prints a row for each cell instead, with its conditions and figures.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import django
import pandas as pd

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
django.setup()

from benchmarks.parsing.accuracy_figures import (  # noqa: E402
    ACCURACY,
    BY_FORM,
    HARMONIC,
    KNOWN,
    ROW,
    UNSEEN,
    as_csv,
    by_plan,
    counts_in_words,
    is_current,
    read_figures,
)
from parser_service.benchmarking.benchmark_cells import CellFile  # noqa: E402
from parser_service.parsers.conditions import PAPERS_SETTINGS, Protocol  # noqa: E402
from parser_service.parsers.registry import parsers  # noqa: E402
from parser_service.results.published import published_accuracy  # noqa: E402
from parser_service.results.table_parts import MARK, MAY_KNOW_CORPORA, may_know_corpora  # noqa: E402

__all__ = ["main", "read_figures", "tables"]

# Criterion → the word for it in a column's head.
CRITERIA = {"command": "command", "source_command": "source", BY_FORM: "form"}
FIGURES = (HARMONIC, UNSEEN, KNOWN, ACCURACY)
# Rows are in the order of the registry; parsers that it no longer has come last.
PLACES = {name: place for place, name in enumerate(parsers())}
ESCAPED = str.maketrans({MARK: r"\textdagger{}", "_": r"\_", "%": r"\%", "#": r"\#"})  # in LaTeX
Column = tuple[str, str, str]  # setting, criterion, figure


@dataclass(frozen=True, slots=True)
class AccuracyFigure:
    """One figure of the table, in percent. ``reach`` is how far its 95 % interval goes to either side at most, None
    where that was not measured;
    ``spread`` the standard deviation between trainings, None for one."""

    mean: float
    reach: float | None
    spread: float | None
    published: float | None
    is_best: bool


@dataclass(frozen=True, slots=True)
class AccuracyTable:
    """One protocol. ``rows`` name, then a figure or None for each of ``columns``."""

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[str, tuple[AccuracyFigure | None, ...]], ...]

    @property
    def has_spread(self) -> bool:
        return any(each and each.spread is not None for _, row in self.rows for each in row)


def tables(figures: pd.DataFrame, of_plans: bool = False) -> list[AccuracyTable]:
    """The tables in the order of the protocols, each with the columns that were measured in it.

    ``of_plans`` says that they count answers with the same plan, of which the paper has no figures.
    """
    return [
        _table(protocol, figures[figures["protocol"] == protocol], of_plans)
        for protocol in Protocol
        if protocol in set(figures["protocol"])
    ]


def _table(protocol: str, figures: pd.DataFrame, of_plans: bool) -> AccuracyTable:
    measured = set(zip(figures["setting"], figures["criterion"], strict=True))
    columns = tuple(
        (setting, by, figure)
        for setting, by, figure in product(map(str, PAPERS_SETTINGS), CRITERIA, FIGURES)
        if (setting, by) in measured and (figure == ACCURACY) == (by != BY_FORM)
    )
    by_row = dict(list(figures.groupby(ROW)))
    order = sorted(by_row, key=lambda key: (PLACES.get(key[0], len(PLACES)), key))
    rows = []
    for key in order:
        own = by_row[key].set_index(["setting", "criterion", "figure"])
        row = [
            _figure(key[0], column, own.loc[column], of_plans) if column in own.index else None
            for column in columns
        ]
        rows.append((_row_name(key, order), tuple(row)))
    title = f"{protocol}, same plan" if of_plans else protocol
    return AccuracyTable(title, columns, tuple(rows))


def _row_name(row: tuple[str, str, str, bool], rows: Sequence[tuple[str, str, str, bool]]) -> str:
    """Return the name of the parser, with the hyperparameters that tell its configurations apart, and what it
    was measured on where that is not the usual."""
    parser, configuration, declared, on_new = row
    values = [json.loads(other) for each, other, *_ in rows if each == parser]
    mine = json.loads(configuration)
    differing = [key for key in mine if any(each.get(key) != mine[key] for each in values)]
    mark = MARK if may_know_corpora(parser) else ""
    name = " ".join([parser + mark, *(f"{key}={mine[key]}" for key in differing)])
    name += ", declared by training" if declared != "all" else ""
    return name + (", new splits" if on_new else "")


def _figure(parser: str, column: Column, row: pd.Series, of_plans: bool) -> AccuracyFigure:
    setting, criterion, figure = column
    train, _, test = setting.rpartition("-")
    mean, low, high = (float(row[name]) for name in ("mean", "low", "high"))
    reach = None if pd.isna(low) else max(high - mean, mean - low)
    spread = None if pd.isna(row["std"]) else float(row["std"])
    is_papers = figure in (ACCURACY, UNSEEN) and not row["on_new"] and not of_plans
    published = published_accuracy(parser, (train, test), criterion) if is_papers else None
    return AccuracyFigure(mean, reach, spread, published, bool(row["is_best"]))


def _heads(table: AccuracyTable) -> list[str]:
    return [
        f"{CRITERIA[by]}{'' if figure == ACCURACY else f', {figure}'}"
        for _, by, figure in table.columns
    ]


def to_markdown(table: AccuracyTable) -> str:
    settings = (setting for setting, _, _ in table.columns)
    head = ["parser", *map(" ".join, zip(settings, _heads(table), strict=True))]
    rule = ["---", *["---:"] * len(table.columns)]
    text = f"### {table.title}\n\n" + _lines([head, rule, *_cells(table, _in_markdown)])
    if not table.has_spread:
        return text

    def spread(figure: AccuracyFigure | None) -> str:
        return "–" if figure is None or figure.spread is None else f"{figure.spread:.1f}"

    spreads = _lines([head, rule, *_cells(table, spread)])
    return f"{text}\n\nStandard deviations between trainings:\n\n{spreads}"


def _lines(rows: Sequence[Sequence[str]]) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _cells(table: AccuracyTable, write: Callable[[AccuracyFigure | None], str]) -> list[list[str]]:
    return [[f"`{name}`", *map(write, row)] for name, row in table.rows]


def to_latex(table: AccuracyTable) -> str:
    """A booktabs tabular; a setting spans its criteria, as in the paper."""
    settings = list(dict.fromkeys(setting for setting, _, _ in table.columns))
    spans = [sum(setting == each for each, _, _ in table.columns) for setting in settings]
    heads = [
        rf"\multicolumn{{{span}}}{{c}}{{{setting}}}"
        for setting, span in zip(settings, spans, strict=True)
    ]
    lines = [
        [table.title, *heads],
        ["", *_heads(table)],
        *(
            [rf"\texttt{{{name.translate(ESCAPED)}}}", *map(_in_latex, row)]
            for name, row in table.rows
        ),
    ]
    first, second, *body = [rf"{' & '.join(line)} \\" for line in lines]
    begin = rf"\begin{{tabular}}{{l{'r' * len(table.columns)}}}"
    return "\n".join(
        [begin, r"\toprule", first, second, r"\midrule", *body, r"\bottomrule", r"\end{tabular}"]
    )


def _in_markdown(figure: AccuracyFigure | None) -> str:
    if figure is None:
        return "–"
    mean = f"**{figure.mean:.1f}**" if figure.is_best else f"{figure.mean:.1f}"
    reach = "" if figure.reach is None else f" ± {figure.reach:.1f}"
    return mean + reach + ("" if figure.published is None else f" ({figure.published:.1f})")


def _in_latex(figure: AccuracyFigure | None) -> str:
    if figure is None:
        return "--"
    mean = rf"\textbf{{{figure.mean:.1f}}}" if figure.is_best else f"{figure.mean:.1f}"
    reach = "" if figure.reach is None else rf" $\pm$ {figure.reach:.1f}"
    paper = "" if figure.published is None else rf" \textcolor{{gray}}{{({figure.published:.1f})}}"
    return mean + reach + paper


def note(figures: pd.DataFrame, part: str, left_out: int) -> str:
    """What the figures are, in sentences."""
    new = figures[figures["on_new"]]
    on_new = [
        f"{counts_in_words(new[new['criterion'] == criterion], 'splits')} by {by}"
        for criterion, by in CRITERIA.items()
        if criterion in set(new["criterion"])
    ]
    seeds = counts_in_words(figures, "seeds")
    sentences = [
        f"Exact match in percent on the {part} parts, mean over {', '.join([seeds, *on_new])}; "
        "±: how far the 95 % interval reaches, by a bootstrap of clusters (forms by form, else source commands) and "
        "trainings; bold: better than every other row of its column, by a paired bootstrap with Holm's "
        "correction; in parentheses: the paper's figures, on its test parts."
    ]
    if BY_FORM in set(figures["criterion"]):
        sentences.append(
            "By form: unseen forms, known ones (utterances of training forms, held out by source command) and "
            "their harmonic mean."
        )
        if Protocol.GRAMMAR in set(figures["protocol"]):
            sentences.append(
                "Under grammar, training has the prompts of the paraphrases of unseen forms, with their forms."
            )
    if figures["low"].isna().any():
        sentences.append("Figures without ± were measured before cells kept their outcomes.")
    if any(map(may_know_corpora, figures["parser"])):
        sentences.append(f"{MARK} {MAY_KNOW_CORPORA}")
    if left_out:
        sentences.append(f"{left_out} cells of other versions of these parsers are left out.")
    return " ".join(sentences)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("cells", type=Path)
    parser.add_argument("--parsers", help="names with commas between them; all by default")
    parser.add_argument("--part", choices=["validation", "test"], default="validation")
    style = parser.add_mutually_exclusive_group()
    style.add_argument("--markdown", dest="show", action="store_const", const=to_markdown)
    style.add_argument("--latex", dest="show", action="store_const", const=to_latex)
    style.add_argument(
        "--csv", action="store_true", help="a row for each cell, not for each parser"
    )
    given = parser.parse_args(arguments)
    show: Callable[[AccuracyTable], str] = given.show or to_markdown
    try:
        if not given.cells.is_file():
            raise ValueError(f"{given.cells} is no file; manage.py benchmark --json writes it.")
        cells = CellFile(given.cells).cells
        names = given.parsers.split(",") if given.parsers else [cell["parser"] for cell in cells]
        if given.csv:
            print(as_csv([cell for cell in cells if cell["parser"] in names]), end="")
            return
        figures = read_figures(cells, given.part, names)
        of_plans = [cell for cell in by_plan(cells) if cell["parser"] in names]
        shown = tables(figures)
        if any(is_current(cell) and f"same_plan_{given.part}" in cell for cell in of_plans):
            shown += tables(read_figures(of_plans, given.part, names), of_plans=True)
    except ValueError as error:
        sys.exit(str(error))
    left_out = sum(cell["parser"] in names and not is_current(cell) for cell in cells)
    comment = "% " if show is to_latex else ""
    print(*map(show, shown), comment + note(figures, given.part, left_out), sep="\n\n")


if __name__ == "__main__":
    main()
