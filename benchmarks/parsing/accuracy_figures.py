"""The figures of an accuracy table, from the cells of ``manage.py benchmark``: means, intervals and what is best."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

import numpy as np
import pandas as pd

from parser_service.analysis.clustered import Clustered, Parts, figures_of, interval_of
from parser_service.analysis.comparing import is_better
from parser_service.parsers.registry import parsers

BY_FORM = "logical_form"
# By form, the three figures of a cell; by what else, the accuracy of the part.
UNSEEN, KNOWN, HARMONIC, ACCURACY = "unseen", "known", "harmonic mean", "accuracy"
ROW = ["parser", "configuration", "declared", "on_new"]
COLUMN = ["setting", "criterion", "figure"]
CONDITIONS = ["protocol", *ROW, *COLUMN]
SAME_CELL = [
    "protocol",
    "parser",
    "configuration",
    "declared",
    "setting",
    "criterion",
    "seed",
    "split",
]


def by_plan(cells: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the cells whose plans were compared, with the answers of the same plan in place of the exact ones."""
    parts = ("validation", "test", KNOWN)
    return [
        {
            **cell,
            **{f"accuracy_{part}": cell.get(f"same_plan_{part}") for part in parts},
            "outcomes": cell.get("outcomes_same_plan"),
        }
        for cell in cells
        if any(cell.get(f"same_plan_{part}") is not None for part in parts)
    ]


def read_figures(
    cells: Sequence[dict[str, Any]], part: str, parsers: Sequence[str]
) -> pd.DataFrame:
    """A row for each of the ``CONDITIONS`` measured, in percent: mean, its 95 % interval ``low`` to ``high``,
    ``std`` between the trainings (NaN for one), whether it ``is_best``, and the number of ``seeds`` and of new
    ``splits``.

    A cell measured again, after the code has changed, replaces the older one; cells of other versions of
    a parser than the current one are left out. Raises ValueError, a sentence, where nothing is left, or
    where the cells of a column do not belong together.
    """
    frame = _newest(pd.DataFrame([cell for cell in cells if cell["parser"] in parsers]), part)
    if frame.empty:
        raise ValueError(f"No cell of these parsers has an accuracy on a {part} part.")
    _check_together(frame, part)
    rows = [
        {**dict(zip(["protocol", *ROW, *COLUMN[:2]], conditions, strict=True)), **figure}
        for conditions, alike in frame.groupby(["protocol", *ROW, *COLUMN[:2]], dropna=False)
        for figure in _figures(alike, part)
    ]
    return _mark_best(pd.DataFrame(rows))


def is_current(cell: dict[str, Any]) -> bool:
    """Return whether a cell is of the current version of its parser; one that says no version may be."""
    version = cell.get("version")
    return (
        version is None
        or cell["parser"] not in parsers()
        or version == parsers()[cell["parser"]].version
    )


def _newest(frame: pd.DataFrame, part: str) -> pd.DataFrame:
    """Return the cells with an accuracy on ``part``, each measurement once, with the columns of ``ROW``."""
    if frame.empty:
        return frame
    frame = frame[[is_current(cell) for cell in frame.to_dict("records")]]
    frame = frame.dropna(subset=[f"accuracy_{part}"])
    for name, default in (("split", np.nan), ("declared", "all"), ("outcomes", None)):
        if name not in frame:
            frame = frame.assign(**{name: default})
    split = pd.to_numeric(frame["split"])
    is_usual = (frame["criterion"] == "source_command") & (split == 0)
    return frame.assign(
        configuration=frame["configuration"].map(lambda each: json.dumps(each, sort_keys=True)),
        declared=frame["declared"].fillna("all"),
        split=split,
        on_new=split.notna() & ~is_usual,
    ).drop_duplicates(SAME_CELL, keep="last")


def _check_together(measured: pd.DataFrame, part: str) -> None:
    for (setting, criterion, _), cells in measured.groupby(["setting", "criterion", "on_new"]):
        for _, numbers in cells.groupby("split", dropna=False)[f"n_{part}"].unique().items():
            if len(numbers) > 1:
                counts = " and ".join(str(count) for count in sorted(numbers))
                raise ValueError(
                    f"{setting} by {criterion} was tested on {counts} pairs: "
                    "these cells are of different folders; keep a file for each."
                )


def _figures(alike: pd.DataFrame, part: str) -> Iterator[dict[str, Any]]:
    """Yield the figures of cells that differ by seed and split alone: one, or three by form."""
    by_form = (alike["criterion"] == BY_FORM).all()
    cells = alike.to_dict("records")
    wanted = (
        {UNSEEN: (part,), KNOWN: (KNOWN,), HARMONIC: (part, KNOWN)}
        if by_form
        else {ACCURACY: (part,)}
    )
    common = {
        "seeds": alike["seed"].nunique(),
        "splits": alike["split"].nunique(),
        "splits_are": str(sorted(alike["split"].dropna().unique())),
    }
    for figure, parts in wanted.items():
        counted = _count(cells, parts)
        if counted is not None:
            low, high = interval_of(counted)
            each = figures_of(counted)
        elif figure in (ACCURACY, UNSEEN):  # measured before cells had their outcomes
            low = high = np.nan
            each = alike[f"accuracy_{part}"].to_numpy(float)
        else:
            continue
        spread = float(np.std(each, ddof=1)) if len(each) > 1 else np.nan
        numbers = {"mean": float(np.mean(each)), "std": spread, "low": low, "high": high}
        percent = {name: 100 * value for name, value in numbers.items()}
        yield {"figure": figure, **percent, **common, "counted": counted}


def _count(cells: Sequence[dict[str, Any]], parts: Sequence[str]) -> Parts | None:
    """Return what the cells got right in each of ``parts``; None where one of them does not say."""
    tallies = [[(cell.get("outcomes") or {}).get(part) for cell in cells] for part in parts]
    if not all(all(each) for each in tallies):
        return None
    return tuple(Clustered.of(each) for each in tallies)  # type: ignore[return-value,arg-type]


def _mark_best(figures: pd.DataFrame) -> pd.DataFrame:
    """Say which figures are better than every other one of their column on the same splits."""
    figures = figures.assign(is_best=False)
    for _, alike in figures.groupby(["protocol", *COLUMN, "on_new", "splits_are"]):
        counted = alike[alike["counted"].notna()].sort_values("mean", ascending=False)
        if len(counted) == len(alike) > 1 and is_better(
            counted["counted"].iloc[0], list(counted["counted"].iloc[1:])
        ):
            figures.loc[counted.index[0], "is_best"] = True
    return figures


def counts_in_words(figures: pd.DataFrame, what: str) -> str:
    """``1 or 3 seeds``; nothing where there are none."""
    counts = [count for count, _ in groupby(sorted(figures[what])) if count]
    word = what.removesuffix("s") if counts == [1] else what
    numbers = " or ".join(map(str, counts))
    return f"{numbers} {'new ' if what == 'splits' else ''}{word}" if counts else ""


def as_csv(cells: Sequence[dict[str, Any]]) -> str:
    """Return a row for each cell with its conditions and figures, as CSV.

    What the intervals are drawn from (the outcomes of each cluster), the risk-coverage curves and the key
    are left out: they make a file of cells a hundred times as long.
    """
    rows = [_row_of(cell) for cell in cells]
    lines = io.StringIO()
    names = dict.fromkeys(name for row in rows for name in row)
    writer = csv.DictWriter(lines, names, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return lines.getvalue()


def _row_of(cell: dict[str, Any]) -> dict[str, Any]:
    row: dict[str, Any] = {}
    for name, value in cell.items():
        if name == "configuration":
            row[name] = json.dumps(value)
        elif name == "calibration":
            for part, measures in value.items():
                single = {key: each for key, each in measures.items() if not isinstance(each, list)}
                row |= {f"{key}_{part}": each for key, each in single.items()}
        elif name.startswith("interval") and value:
            row |= dict(zip((f"{name}_low", f"{name}_high"), value, strict=True))
        elif name not in ("outcomes", "outcomes_same_plan", "key"):
            row[name] = round(value, 6) if isinstance(value, float) else value
    return row
