"""The results pages: how often each parser is right."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import Http404, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.people.access import WRITE, WorldRequest, world_view
from parser_service.results.answerer_rows import answerer_tables
from parser_service.results.export import ResultsFormat
from parser_service.results.measuring_job import request_measurement
from parser_service.results.result_choices import read_choices, scored_splits
from parser_service.web.results.result_files import results_file


@world_view(Duty.VIEW)
def results(request: WorldRequest, world: World) -> HttpResponse:
    """Show the accuracy table, with a group of rows for each protocol."""
    context = results_of(request, world)
    context["answerer"] = answerer_tables(world, context["chosen"], context["part"])
    return render(request, "parser_service/results/results.html", context)


@never_cache
@world_view(Duty.VIEW)
def results_table(request: WorldRequest, world: World) -> HttpResponse:
    """Show the tables alone; the page refreshes itself with them."""
    return render(request, "parser_service/results/_results_table.html", results_of(request, world))


@world_view(Duty.REVIEW, WRITE, does="measure what a robot gets")
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
def results_download(request: WorldRequest, world: World, as_: str) -> HttpResponse:
    """Download what the tables show; ``as_`` is a ``ResultsFormat``."""
    if as_ not in [*ResultsFormat]:
        raise Http404("There is no such format.")
    return results_file(world, request.GET, as_)


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
