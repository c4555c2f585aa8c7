"""What a worker has found out about a run (``RunAnalysis``), as a report shows it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from django.utils.safestring import SafeString

from parser_service.analysing.probes.kinds import PROBE_KINDS
from parser_service.analysis.sensitivity import ALL_KINDS
from parser_service.reporting.charts import Line, draw_lines

MOST_ATTRACTORS = 15
SOURCES = {"para": "paraphrases", "gen": "generated commands"}


def attractor_tables(
    findings: Mapping[str, Sequence[Mapping[str, Any]]],
) -> Iterator[tuple[str, Sequence[Mapping[str, Any]], int]]:
    """Yield source in words, its first rows, and how many there are."""
    for source, rows in findings.items():
        yield SOURCES.get(source, source), rows[:MOST_ATTRACTORS], len(rows)


def refusal_curves(findings: Mapping[str, Mapping[str, Any]]) -> SafeString:
    """Draw the share of wrong answers by the share of utterances that are answered, a line a source."""
    lines = [
        Line(
            source,
            [100 * answered / curve["count"] for answered in curve["answered"]],
            [
                100 * wrong / answered if answered else None
                for wrong, answered in zip(curve["wrong"], curve["answered"], strict=True)
            ],
        )
        for source, curve in findings.items()
    ]
    return draw_lines(
        "Share of wrong answers by the share of utterances that are answered",
        lines,
        "answered, % of the utterances",
        "wrong, % of the answers",
        x_most=100.0,
    )


def edit_rows(
    findings: Sequence[Mapping[str, Any]],
) -> list[tuple[str, Mapping[str, Any]]]:
    """Return each kind of edit in words, with its row; all of them together come last."""
    names = {**{str(kind): name for kind, name in PROBE_KINDS.items()}, ALL_KINDS: "all edits"}
    return [(names.get(row["kind"], row["kind"]), row) for row in findings]
