"""Unexpected defaults of a run: forms that attract unlike inputs, probes, and what refusing to answer saves."""

from __future__ import annotations

from typing import Any
from urllib.parse import urlencode

from django.http import HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.models import Duty, World
from annotations.people.access import WorldRequest, world_view
from parser_service.models import TrainingRun
from parser_service.parsers.conditions import in_words
from parser_service.reviews.refusal_curves import FACTS, curve_chart, place_of, points_of
from parser_service.reviews.state import analysis_of
from parser_service.reviews.stored_findings import findings_of
from parser_service.reviews.summaries import paper_texts, runs_beside, summaries_of
from parser_service.reviews.target import SOURCES, parts_of
from parser_service.web.page_of_run import head_of


@world_view(Duty.VIEW)
def defaults(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show the findings on one part and source; ``bound`` is the position of the slider."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    parts = parts_of(run)
    part = _choose(request.GET.get("part", ""), parts)
    findings = findings_of(run, part)
    attractors = findings.get("attractors", {})
    sources = [name for name in SOURCES if name in attractors]  # a database may sort its JSON
    source = _choose(request.GET.get("source", ""), sources)
    paper_runs = [run, *runs_beside(run)]
    context = {
        **head_of(run, "Unexpected defaults"),
        "analysis": analysis_of(run),
        "parts": parts,
        "part": part,
        "sources": [(name, in_words(name)) for name in sources],
        "source": source,
        "of_part": urlencode({"part": part, "source": SOURCES.get(source, "")}),
        "attractors": attractors.get(source),
        "paper_runs": paper_runs,
        "paper_texts": paper_texts(paper_runs),
        "summaries": summaries_of(run),
        **_refusal(findings.get("risk_coverage", {}).get(source), request.GET.get("bound", "")),
    }
    return render(request, "parser_service/results/defaults.html", context)


def _choose(wanted: str, names: list[str]) -> str:
    """Return the name that is asked for, or the first; empty where there is none."""
    return wanted if wanted in names else next(iter(names), "")


def _refusal(curve: dict[str, Any] | None, bound: str) -> dict[str, Any]:
    """Return the context of the slider and its chart; empty without a curve."""
    if curve is None:
        return {}
    points = points_of(curve)
    place = place_of(points, bound)
    chosen = points[place]
    return {
        "curve": curve,
        "place": place,
        "last_place": len(points) - 1,
        "chosen": chosen,
        "facts": list(zip(FACTS, chosen.facts, strict=True)),
        "points": [[point.bound, point.shown, point.sentence, *point.facts] for point in points],
        "chart": curve_chart(points, place),
    }
