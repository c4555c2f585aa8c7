"""The results pages: how often each parser is right."""

from __future__ import annotations

import csv
from typing import Any

from django.contrib import messages
from django.http import HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.exchange.split_export import formula_safe
from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.people.access import WRITE, WorldRequest, world_view
from parser_service.results.answerer_rows import answerer_tables
from parser_service.results.export import HEADER, as_json, rows_of
from parser_service.results.latex import as_latex
from parser_service.results.measuring_job import request_measurement
from parser_service.results.result_choices import read_choices, scored_splits


@world_view(Duty.VIEW)
def results(request: WorldRequest, world: World) -> HttpResponse:
    """Show the accuracy tables, one per protocol."""
    context = results_of(request, world)
    context["answerer"] = answerer_tables(world, context["chosen"], context["part"])
    return render(request, "parser_service/results/results.html", context)


@never_cache
@world_view(Duty.VIEW)
def results_table(request: WorldRequest, world: World) -> HttpResponse:
    """Show the tables alone; the page refreshes itself with them."""
    return render(request, "parser_service/results/_results_table.html", results_of(request, world))


@world_view(Duty.REVIEW, WRITE)
def results_measure(request: WorldRequest, world: World) -> HttpResponse:
    """Start to measure what a robot gets, or show the measurement that waits or runs."""
    key = request.POST.get("split", "")
    split = get_object_or_404(world.splits, pk=key) if key.isdecimal() else None
    try:
        job = request_measurement(world, request.user, split)
    except Refusal as refusal:
        messages.error(request, refusal.message)
        return redirect("results", world=world.name)
    return redirect("job", pk=job.pk)


@world_view(Duty.VIEW)
def results_csv(request: WorldRequest, world: World) -> HttpResponse:
    """Download what the tables show, one figure per line."""
    choices = read_choices(request.GET, world, scored_splits(world))
    response = HttpResponse(
        content_type="text/csv; charset=utf-8", headers=as_attachment(world, "csv")
    )
    writer = csv.writer(response)
    writer.writerow(HEADER)
    rows = rows_of(choices.tables(world))
    writer.writerows([formula_safe(cell) for cell in row] for row in rows)
    return response


@world_view(Duty.VIEW)
def results_latex(request: WorldRequest, world: World) -> HttpResponse:
    """Download the tables for a paper."""
    choices = read_choices(request.GET, world, scored_splits(world))
    return HttpResponse(
        as_latex(choices, choices.tables(world)),
        content_type="application/x-tex; charset=utf-8",
        headers=as_attachment(world, "tex"),
    )


@world_view(Duty.VIEW)
def results_json(request: WorldRequest, world: World) -> HttpResponse:
    """Download the choices of the page and what its tables show."""
    choices = read_choices(request.GET, world, scored_splits(world))
    shown = as_json(world, choices, choices.tables(world))
    options = {"indent": 1, "ensure_ascii": False}
    return JsonResponse(shown, json_dumps_params=options, headers=as_attachment(world, "json"))


def as_attachment(world: World, ending: str) -> dict[str, str]:
    """Return the header with which a browser stores an answer as a file."""
    return {"Content-Disposition": f'attachment; filename="{world.name}-results.{ending}"'}


def results_of(request: WorldRequest, world: World) -> dict[str, Any]:
    """Return the tables that the address chooses, and its choices."""
    splits = scored_splits(world)
    choices = read_choices(request.GET, world, splits)
    tables = choices.tables(world)
    return {
        "tables": tables,
        "is_active": any(table.is_active for table in tables),
        "is_scored": any(table.is_scored for table in tables),
        "is_by_criterion": any(table.is_by_criterion for table in tables),
        "rows": [row for table in tables for row in table.rows],
        "is_published": any(table.is_published for table in tables),
        "choices": choices,
        "part": choices.part,
        "splits": splits,
        "chosen": choices.splits,
    }
