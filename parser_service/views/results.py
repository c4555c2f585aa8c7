"""The results pages: how often each parser is right."""

from __future__ import annotations

import csv

from django.http import HttpRequest, HttpResponse
from django.shortcuts import render
from django.views.decorators.cache import never_cache

from annotations.exporting.split_export import formula_safe
from annotations.models import Duty, World
from annotations.models.splits import Part
from annotations.people.access import world_view
from parser_service.results.accuracy import accuracy_tables
from parser_service.results.export import HEADER, rows_of

PARTS = (Part.VALIDATION, Part.TEST)
MOST_SPLITS = 4  # side by side without a choice


@world_view(Duty.VIEW)
def results(request: HttpRequest, world: World) -> HttpResponse:
    """Show the accuracy tables, one per protocol."""
    return render(request, "parser_service/results.html", results_of(request, world))


@never_cache
@world_view(Duty.VIEW)
def results_table(request: HttpRequest, world: World) -> HttpResponse:
    """Show the tables alone; the page refreshes itself with them."""
    return render(request, "parser_service/_results_table.html", results_of(request, world))


@world_view(Duty.VIEW)
def results_csv(request: HttpRequest, world: World) -> HttpResponse:
    """Download what the tables show, one cell per line, as fractions of 1."""
    disposition = f'attachment; filename="{world.name}-results.csv"'
    response = HttpResponse(
        content_type="text/csv; charset=utf-8", headers={"Content-Disposition": disposition}
    )
    writer = csv.writer(response)
    writer.writerow(HEADER)
    rows = rows_of(results_of(request, world)["tables"])
    writer.writerows([formula_safe(cell) for cell in row] for row in rows)
    return response


def results_of(request: HttpRequest, world: World) -> dict[str, object]:
    """Return the tables for the part and splits named in the URL, by default the newest splits."""
    splits = list(world.splits.filter(runs__isnull=False).distinct())
    names = request.GET.getlist("split")
    chosen = [split for split in splits if split.name in names] or splits[:MOST_SPLITS]
    part = request.GET.get("part", "")
    part = part if part in PARTS else default_part(world)
    tables = accuracy_tables(world, part, chosen)
    return {
        "tables": tables,
        "is_active": any(table.is_active for table in tables),
        "is_scored": any(table.is_scored for table in tables),
        "is_by_criterion": any(table.is_by_criterion for table in tables),
        "is_published": any(table.is_published for table in tables),
        "parts": PARTS,
        "part": part,
        "splits": splits,
        "chosen": chosen,
    }


def default_part(world: World) -> str:
    """Return the test part, unless nothing has been scored on one."""
    is_tested = world.runs.filter(evaluations__part=Part.TEST).exists()
    return Part.TEST if is_tested else Part.VALIDATION
