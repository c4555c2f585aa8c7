"""The paper's accuracy table, from the cells of ``manage.py benchmark``.

    .venv/bin/python -m benchmarks.parsing.accuracy cells.json [--markdown | --latex] [--part validation]

One table per protocol, with a row for each parser and a column for each setting and criterion. A figure is
exact match in percent, the mean over seeds and over new splits where there are any; ± is their standard
deviation (n − 1). The best of a column is bold. The paper's figure, always on the test parts, is in
parentheses.
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
from typing import Any

import django
import pandas as pd

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
django.setup()

from parser_service.benchmarking.cells import CellFile  # noqa: E402
from parser_service.parsers.conditions import SETTINGS, Protocol  # noqa: E402
from parser_service.parsers.registry import PARSERS  # noqa: E402
from parser_service.results.published import published_accuracy  # noqa: E402

# Criterion → the word for it in a column's head.
CRITERIA = {"command": "command", "source_command": "source", "logical_form": "form"}
# Rows are in the order of the registry; parsers that it no longer has come last.
PLACES = {name: place for place, name in enumerate(PARSERS)}
CONDITIONS = ["protocol", "parser", "configuration", "setting", "criterion"]


@dataclass(frozen=True, slots=True)
class Figure:
    """One figure of the table, in percent; ``spread`` is None for one seed."""

    mean: float
    spread: float | None
    published: float | None
    is_best: bool


def read_figures(
    cells: Sequence[dict[str, Any]], part: str, parsers: Sequence[str]
) -> pd.DataFrame:
    """A row for each of the ``CONDITIONS`` measured, with mean, std (NaN for one cell), and the number
    of ``seeds`` and of new ``splits``.

    A cell measured again, after the code has changed, replaces the older one. Raises ValueError, a
    sentence, where nothing is left, or where the cells of a column do not belong together.
    """
    frame = pd.DataFrame([cell for cell in cells if cell["parser"] in parsers])
    measured = frame.dropna(subset=[f"accuracy_{part}"]) if len(frame) else frame
    if measured.empty:
        raise ValueError(f"No cell of these parsers has an accuracy on a {part} part.")
    if "split" not in measured:
        measured = measured.assign(split=None)
    measured = measured.assign(
        configuration=measured["configuration"].map(lambda each: json.dumps(each, sort_keys=True)),
        percent=100 * measured[f"accuracy_{part}"].astype(float),
    ).drop_duplicates([*CONDITIONS, "seed", "split"], keep="last")
    _check_together(measured, part)
    figures = measured.groupby(CONDITIONS).agg(
        mean=("percent", "mean"),
        std=("percent", "std"),
        seeds=("seed", "nunique"),
        splits=("split", "nunique"),
    )
    return figures.reset_index()


def _check_together(measured: pd.DataFrame, part: str) -> None:
    for (setting, criterion), cells in measured.groupby(["setting", "criterion"]):
        if cells["split"].isna().any() and cells["split"].notna().any():
            raise ValueError(
                f"{setting} by {criterion} was measured on the published split and on new ones; keep a "
                "file for each."
            )
        for _, numbers in cells.groupby("split", dropna=False)[f"n_{part}"].unique().items():
            if len(numbers) > 1:
                counts = " and ".join(str(count) for count in sorted(numbers))
                raise ValueError(
                    f"{setting} by {criterion} was tested on {counts} pairs: "
                    "these cells are of different folders; keep a file for each."
                )


@dataclass(frozen=True, slots=True)
class Table:
    """One protocol. ``columns`` are (setting, criterion); ``rows`` name, then a figure or None each."""

    protocol: str
    columns: tuple[tuple[str, str], ...]
    rows: tuple[tuple[str, tuple[Figure | None, ...]], ...]


def tables(figures: pd.DataFrame) -> list[Table]:
    """The tables in the order of the protocols, each with the columns that were measured in it."""
    return [
        _table(protocol, figures[figures["protocol"] == protocol])
        for protocol in Protocol
        if protocol in set(figures["protocol"])
    ]


def _table(protocol: str, figures: pd.DataFrame) -> Table:
    measured = set(zip(figures["setting"], figures["criterion"], strict=True))
    columns = tuple(each for each in product(map(str, SETTINGS), CRITERIA) if each in measured)
    best = figures.groupby(["setting", "criterion"])["mean"].max()
    by_row = dict(list(figures.groupby(["parser", "configuration"])))
    order = sorted(by_row, key=lambda key: (PLACES.get(key[0], len(PLACES)), key))
    rows = []
    for parser, configuration in order:
        own = by_row[parser, configuration].set_index(["setting", "criterion"])
        name = _row_name(parser, configuration, [other for each, other in order if each == parser])
        row = [
            _figure(parser, column, own.loc[column], best[column]) if column in own.index else None
            for column in columns
        ]
        rows.append((name, tuple(row)))
    return Table(protocol, columns, tuple(rows))


def _row_name(parser: str, configuration: str, configurations: Sequence[str]) -> str:
    """The parser; with what distinguishes this one of its ``configurations``, if there are several."""
    values = [json.loads(each) for each in configurations]
    mine = json.loads(configuration)
    differing = [key for key in mine if any(each.get(key) != mine[key] for each in values)]
    return " ".join([parser, *(f"{key}={mine[key]}" for key in differing)])


def _figure(parser: str, column: tuple[str, str], row: pd.Series, best: float) -> Figure:
    setting, criterion = column
    train, _, test = setting.rpartition("-")
    spread = None if pd.isna(row["std"]) else float(row["std"])
    published = published_accuracy(parser, (train, test), criterion)
    return Figure(float(row["mean"]), spread, published, bool(row["mean"] == best))


def to_markdown(table: Table) -> str:
    head = ["parser", *(f"{setting} {CRITERIA[by]}" for setting, by in table.columns)]
    rows = [[f"`{name}`", *map(_in_markdown, row)] for name, row in table.rows]
    lines = [head, ["---", *["---:"] * len(table.columns)], *rows]
    return "\n".join([f"### {table.protocol}", "", *(f"| {' | '.join(line)} |" for line in lines)])


def to_latex(table: Table) -> str:
    """A booktabs tabular; a setting spans its criteria, as in the paper."""
    settings = list(dict.fromkeys(setting for setting, _ in table.columns))
    spans = [sum(setting == each for each, _ in table.columns) for setting in settings]
    heads = [
        rf"\multicolumn{{{span}}}{{c}}{{{setting}}}"
        for setting, span in zip(settings, spans, strict=True)
    ]
    lines = [
        [table.protocol, *heads],
        ["", *(CRITERIA[by] for _, by in table.columns)],
        *([rf"\texttt{{{_escape(name)}}}", *map(_in_latex, row)] for name, row in table.rows),
    ]
    first, second, *body = [rf"{' & '.join(line)} \\" for line in lines]
    begin = rf"\begin{{tabular}}{{l{'r' * len(table.columns)}}}"
    return "\n".join(
        [begin, r"\toprule", first, second, r"\midrule", *body, r"\bottomrule", r"\end{tabular}"]
    )


def _in_markdown(figure: Figure | None) -> str:
    if figure is None:
        return "–"
    mean = f"**{figure.mean:.1f}**" if figure.is_best else f"{figure.mean:.1f}"
    spread = "" if figure.spread is None else f" ± {figure.spread:.1f}"
    return mean + spread + ("" if figure.published is None else f" ({figure.published:.1f})")


def _in_latex(figure: Figure | None) -> str:
    if figure is None:
        return "--"
    mean = rf"\textbf{{{figure.mean:.1f}}}" if figure.is_best else f"{figure.mean:.1f}"
    spread = "" if figure.spread is None else rf" $\pm$ {figure.spread:.1f}"
    paper = "" if figure.published is None else rf" \textcolor{{gray}}{{({figure.published:.1f})}}"
    return mean + spread + paper


def _escape(name: str) -> str:
    return name.replace("_", r"\_").replace("%", r"\%").replace("#", r"\#")


def note(figures: pd.DataFrame, part: str) -> str:
    """What the figures are, in sentences."""
    new = [_count(figures[figures["criterion"] == each], "splits") for each in CRITERIA]
    on_new = [f"{how} by {by}" for how, by in zip(new, CRITERIA.values(), strict=True) if how]
    return (
        f"Exact match in percent on the {part} parts, mean ± standard deviation over "
        f"{_count(figures, 'seeds')}{''.join(f', {each}' for each in on_new)}; "
        "bold: the best of its column; in parentheses: the paper's figures, on its test parts."
    )


def _count(figures: pd.DataFrame, what: str) -> str:
    """``1 or 3 seeds``; nothing where there are none."""
    counts = [count for count in sorted(figures[what].unique()) if count]
    word = what.removesuffix("s") if counts == [1] else what
    numbers = " or ".join(map(str, counts))
    return f"{numbers} {'new ' if what == 'splits' else ''}{word}" if counts else ""


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("cells", type=Path)
    parser.add_argument("--parsers", help="names with commas between them; all by default")
    parser.add_argument("--part", choices=["validation", "test"], default="validation")
    style = parser.add_mutually_exclusive_group()
    style.add_argument("--markdown", dest="show", action="store_const", const=to_markdown)
    style.add_argument("--latex", dest="show", action="store_const", const=to_latex)
    given = parser.parse_args(arguments)
    show: Callable[[Table], str] = given.show or to_markdown
    try:
        if not given.cells.is_file():
            raise ValueError(f"{given.cells} is no file; manage.py benchmark --json writes it.")
        cells = CellFile(given.cells).cells
        names = given.parsers.split(",") if given.parsers else [cell["parser"] for cell in cells]
        figures = read_figures(cells, given.part, names)
    except ValueError as error:
        sys.exit(str(error))
    comment = "% " if show is to_latex else ""
    print(*map(show, tables(figures)), comment + note(figures, given.part), sep="\n\n")


if __name__ == "__main__":
    main()
