"""How well people agree, and how much everybody has done."""

from __future__ import annotations

from typing import Any

from django.http import HttpResponse
from django.shortcuts import render

from annotations.labelling.agreeing import report_agreement
from annotations.labelling.queue_progress import QueueProgress, progress_of
from annotations.models import Duty, World
from annotations.people.access import WorldRequest, world_view

MOST_LINES = 6  # people who have a line of their own in the chart


@world_view(Duty.VIEW)
def agreement(request: WorldRequest, world: World) -> HttpResponse:
    """Show exact match, Krippendorff's α and Gwet's AC1, each explained, and where people disagree."""
    report = report_agreement(world)
    overall = report.overall
    context = {
        "report": report,
        "coefficients": [
            ("Exact match", overall.exact_match),
            ("Krippendorff's α", overall.alpha),
            ("Gwet's AC1", overall.ac1),
        ],
        "tables": [("Task category", report.by_category), ("Head predicate", report.by_head)],
    }
    return render(request, "annotations/labelling/agreement.html", context)


@world_view(Duty.VIEW)
def progress(request: WorldRequest, world: World) -> HttpResponse:
    """Show the items that each person has done, day by day."""
    done = progress_of(world)
    return render(
        request,
        "annotations/labelling/progress.html",
        {"progress": done, "chart": chart_of(done)},
    )


def chart_of(progress: QueueProgress) -> dict[str, Any]:
    """Return the chart of items a day; people beyond ``MOST_LINES`` are one line together."""
    lines = [
        {"name": each.person, "values": list(each.days)} for each in progress.people[:MOST_LINES]
    ]
    if rest := progress.people[MOST_LINES:]:
        together = [sum(counts) for counts in zip(*(each.days for each in rest), strict=True)]
        lines.append({"name": "others", "values": together})
    days = [f"{day:%-d %b}" for day in progress.days]
    return {
        "x": {"label": "Day", "values": days},
        "y": {"label": "Items", "unit": ""},
        "series": lines,
        "done": True,
    }
