"""The answers of a run beside the labels; those in doubt go back to annotators."""

from __future__ import annotations

from django.http import HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.models import Duty, World
from annotations.people.access import WRITE, PageRequest, WorldRequest, world_view
from annotations.showing.listing import Listing, Sort
from annotations.web.labelling.sending_pages import go_back, send
from parser_service.models import TrainingRun
from parser_service.results.prediction_filters import PredictionFilters
from parser_service.results.selecting import slice_query
from parser_service.web.page_of_run import head_of

SORTS = {
    "position": Sort("No.", "example_id", is_number=True),
    "utterance": Sort("Utterance", "example__utterance"),
    "score": Sort("Score", "score", is_number=True),
}


@world_view(Duty.VIEW)
def predictions(request: WorldRequest, world: World, pk: int) -> HttpResponse:
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
    return render(request, "parser_service/reviews/predictions.html", context)


def listing_of(request: PageRequest, run: TrainingRun) -> Listing:
    rows = run.predictions.best().select_related("example")
    return Listing(request, PredictionFilters, rows, SORTS, of_run=run)


@world_view(Duty.REVIEW, WRITE, does="send answers to the work queue")
def predictions_send(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Put what is behind the answers that pass the filters of the URL into the work queue."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    rows = listing_of(request, run).matching.order_by("example_id")
    examples = (row.example for row in rows.iterator(chunk_size=500))
    send(request, world, examples)
    return go_back(request, "predictions", world=world.name, pk=pk)
