"""How the answers of runs change when utterances are edited."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from django.http import HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.models import Duty, World
from annotations.people.access import WorldRequest, world_view
from parser_service.analysis.edit import EditKind
from parser_service.analysis.sensitivity import ALL_KINDS
from parser_service.models import TrainingRun
from parser_service.reviews.probe_kinds import PROBE_KINDS
from parser_service.reviews.state import analysis_of
from parser_service.reviews.stored_findings import findings_of
from parser_service.reviews.summaries import paper_texts, runs_beside
from parser_service.reviews.target import parts_of
from parser_service.web.page_of_run import head_of
from parser_service.web.runs.asked_runs import asked_runs, runs_to_choose


@dataclass(frozen=True, slots=True)
class KindOfEdit:
    """A kind of edit and, for each run, its row of ``Sensitivity``, None where it has none."""

    kind: str
    name: str
    keeps_meaning: bool | None
    rows: list[tuple[TrainingRun, dict[str, Any] | None]]


@world_view(Duty.VIEW)
def sensitivity(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show flip rates, deciding words and pairs of one run; the flip rates of those that ``run`` names too."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    others = [each for each in asked_runs(request.GET, world) if each.pk != run.pk]
    parts = parts_of(run)
    findings = findings_of(run, parts[0]) if parts else {}
    paper_runs = [run, *(others or runs_beside(run))]
    context = {
        **head_of(run, "Sensitivity"),
        "analysis": analysis_of(run),
        "part": parts[0] if parts else "",
        "others": others,
        "choices": [each for each in runs_to_choose(world) if each.pk != run.pk],
        "kinds": _kinds_of([run, *others]),
        "words": findings.get("deciding_words"),
        "pairs": findings.get("pairs"),
        "paper_runs": paper_runs,
        "paper_texts": paper_texts(paper_runs),
    }
    return render(request, "parser_service/results/sensitivity.html", context)


def _kinds_of(runs: Sequence[TrainingRun]) -> list[KindOfEdit]:
    """Return the kinds of edits that any of the runs was probed with; all together come last."""
    found: list[tuple[TrainingRun, dict[str, dict[str, Any]]]] = []
    for run in runs:
        parts = parts_of(run)
        of_run = findings_of(run, parts[0]).get("sensitivity", []) if parts else []
        found.append((run, {row["kind"]: row for row in of_run}))
    names = {**{str(kind): name for kind, name in PROBE_KINDS.items()}, ALL_KINDS: "all edits"}
    kinds = [str(kind) for kind in EditKind] + [ALL_KINDS]
    return [
        KindOfEdit(
            kind=kind,
            name=names[kind],
            keeps_meaning=None if kind == ALL_KINDS else EditKind(kind).keeps_meaning,
            rows=[(run, rows.get(kind)) for run, rows in found],
        )
        for kind in kinds
        if any(kind in rows for _, rows in found)
    ]
