"""The probes of a run: texts beyond its split, and what it answers to them."""

from __future__ import annotations

from django.db.models import OuterRef, Subquery
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.lists.listing import Listing, Sort
from annotations.models import Duty, World
from annotations.people.access import world_view
from parser_service.analysing.state import analysis_of
from parser_service.filters import ProbeFilters
from parser_service.models import TrainingRun
from parser_service.views.page_of_run import head_of

SORTS = {"position": Sort("Text", "position")}


@world_view(Duty.VIEW)
def probes(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """List the probes that were answered, each beside the answer to the utterance that it was made of."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    first = run.predictions.best().filter(example=OuterRef("base")).values("logical_form")[:1]
    rows = run.probes.filter(answer__isnull=False).select_related("base", "answer")
    context = {
        **head_of(run, "Probes"),
        "analysis": analysis_of(run),
        "listing": Listing(request, ProbeFilters, rows.annotate(before=Subquery(first)), SORTS),
    }
    return render(request, "parser_service/probes.html", context)
