"""The accuracy tables in LaTeX, with booktabs: what the page shows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import accumulate, pairwise

from parser_service.results.accuracy_cells import Cell
from parser_service.results.result_choices import ResultsChoices
from parser_service.results.seed_figures import AccuracyFigure
from parser_service.results.table_parts import (
    MAY_KNOW_CORPORA,
    AccuracyTable,
    TableColumn,
    TableRow,
    may_know_corpora,
)

ESCAPES = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': "''",
}
SIGN = r"$^\dagger$"  # the mark
PREAMBLE = r"% Needs \usepackage{booktabs} in the preamble."


def escape(text: str) -> str:
    """Return ``text`` as LaTeX prints it; line breaks and other control characters become spaces."""
    return "".join(ESCAPES.get(sign, sign if sign.isprintable() else " ") for sign in str(text))


def as_latex(choices: ResultsChoices, tables: Iterable[AccuracyTable]) -> str:
    """Return one table per protocol, to be read by ``\\input``."""
    return "\n\n".join([PREAMBLE, *(_table(choices, table) for table in tables)]) + "\n"


def _table(choices: ResultsChoices, table: AccuracyTable) -> str:
    width = len(table.columns) * len(table.measures)
    return "\n".join(
        [
            r"\begin{table}",
            r"\centering",
            rf"\caption{{{_caption(choices, table)}}}",
            rf"\begin{{tabular}}{{l{'r' * width}}}",
            r"\toprule",
            *_heads(table),
            r"\midrule",
            *(_row(row, cells, table) for row, cells in table.filled),
            r"\bottomrule",
            r"\end{tabular}",
            r"\end{table}",
        ]
    )


def _caption(choices: ResultsChoices, table: AccuracyTable) -> str:
    *others, last = (measure.in_words for measure in table.measures)
    measures = f"{', '.join(others)} and {last}" if others else last
    sentences = [
        f"{measures[0].upper()}{measures[1:]} in percent on the {choices.part} part, "
        f"{table.protocol} protocol.",
        "±: how far the 95 % interval reaches, by a bootstrap of clusters and seeds.",
        "Bold: better than every other row, by a paired bootstrap with Holm's correction.",
    ]
    cells = [cell for row in table.rows for cell in row.cells if cell]
    if any(figure and figure.parts for cell in cells for figure in cell.figures):
        sentences.append("By form: the harmonic mean of unseen and known forms.")
    if table.is_published and choices.published:
        sentences.append("In parentheses: Walker, Peng and Cakmak (2019).")
    caption = escape(" ".join(sentences)).replace("±", r"$\pm$")
    if any(may_know_corpora(row.parser) for row in table.rows):
        return f"{caption} {SIGN} {escape(MAY_KNOW_CORPORA)}"
    return caption


def _heads(table: AccuracyTable) -> Iterator[str]:
    """Yield the lines of the head: settings, splits and, if there are several, measures."""
    each = len(table.measures)
    spans = [each * head.width for head in table.settings]
    titles = [escape(head.notation).replace("→", r"$\rightarrow$") for head in table.settings]
    yield _line("Parser", map(_across, spans, titles))
    ends = list(accumulate(spans, initial=1))
    yield " ".join(rf"\cmidrule(lr){{{before + 1}-{end}}}" for before, end in pairwise(ends))
    yield _line("", (_across(each, escape(column.label)) for column in table.columns))
    if each > 1:
        names = [escape(measure.in_words) for measure in table.measures]
        yield _line("", names * len(table.columns))


def _across(columns: int, text: str) -> str:
    return rf"\multicolumn{{{columns}}}{{c}}{{{text}}}"


def _line(first: str, others: Iterable[str]) -> str:
    return rf"{' & '.join([first, *others])} \\"


def _row(
    row: TableRow, cells: Iterable[tuple[TableColumn, Cell | None]], table: AccuracyTable
) -> str:
    figures: list[str] = []
    for _, cell in cells:
        if cell and cell.figures:
            figures += map(_figure, cell.figures)
        else:
            figures += [cell.status if cell else "--"] * len(table.measures)
    changes = ", ".join(f"{name} {value}" for name, value in row.changes)
    name = escape(f"{row.title} ({changes})" if changes else row.title)
    return _line(f"{name}{SIGN if may_know_corpora(row.parser) else ''}", figures)


def _figure(figure: AccuracyFigure | None) -> str:
    if figure is None:
        return "--"
    percent = f"{figure.percent:.1f}"
    parts = [rf"\textbf{{{percent}}}" if figure.is_best else percent]
    parts.append(rf"{{\scriptsize $\pm$ {figure.reach:.1f}}}")
    if figure.parts:
        both = ", ".join(f"{part.label} {part.percent:.1f}" for part in figure.parts)
        parts.append(rf"{{\scriptsize ({both})}}")
    if figure.alone:
        parts.append(r"{\scriptsize (unseen alone)}")
    if figure.published is not None:
        parts.append(rf"{{\scriptsize ({figure.published:.1f})}}")
    return " ".join(parts)
