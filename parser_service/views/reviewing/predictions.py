"""The answers of a run beside the annotated forms."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.lists.listing import Listing, Sort
from annotations.models import Duty, World
from annotations.people.access import world_view
from parser_service.models import TrainingRun
from parser_service.slices import PredictionFilters, slice_query
from parser_service.views.page_of_run import head_of

SORTS = {
    "position": Sort("No.", "example_id", is_number=True),
    "utterance": Sort("Utterance", "example__utterance"),
    "score": Sort("Score", "score", is_number=True),
}


@world_view(Duty.VIEW)
def predictions(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """List the first answer to every example, filtered by the URL."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    listing = listing_of(request, run)
    filters = listing.url(sort="").removeprefix("?")
    context = {
        **head_of(run, "Predictions"),
        "listing": listing,
        "filters": f"{filters}&" if filters else "",
        "slice_query": slice_query(world, request.GET),
    }
    return render(request, "parser_service/predictions.html", context)


def listing_of(request: HttpRequest, run: TrainingRun) -> Listing:
    rows = run.predictions.best().select_related("example")
    return Listing(request, PredictionFilters, rows, SORTS, of_run=run)
