"""The answers of a run beside the annotated forms."""

from __future__ import annotations

from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.lists.listing import Listing, Sort
from annotations.models import Duty, World
from annotations.people.access import world_view
from annotations.rows.occurrences import command_of_example
from parser_service.models import TrainingRun
from parser_service.slices import PredictionFilters, slice_query

SORTS = {
    "position": Sort("No.", "example_id", is_number=True),
    "utterance": Sort("Utterance", "example__utterance"),
    "score": Sort("Score", "score", is_number=True),
}


@world_view(Duty.VIEW)
def predictions(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """List the first answer to every example, filtered by the URL."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    aside = f"{run.parser}, run {run.pk}"
    context = {
        "run": run,
        "aside": aside,
        "listing": listing_of(request, run),
        "slice_query": slice_query(world, request.GET),
    }
    return render(request, "parser_service/predictions.html", context)


@world_view(Duty.VIEW)
def prediction(request: HttpRequest, world: World, pk: int, example: int) -> HttpResponse:
    """Show all candidates for one example, with links to its neighbours in the filtered list."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    candidates = list(
        run.predictions.filter(example=example).select_related("example__split__world")
    )
    if not candidates:
        raise Http404("This run has no answer stored for that example.")
    context = {
        "run": run,
        "example": candidates[0].example,
        "candidates": candidates,
        "command": command_of_example(candidates[0].example),
        "neighbours": neighbours_of(listing_of(request, run), example),
        "query": request.GET.urlencode(),
    }
    return render(request, "parser_service/prediction.html", context)


def listing_of(request: HttpRequest, run: TrainingRun) -> Listing:
    rows = run.predictions.best().select_related("example")
    return Listing(request, PredictionFilters, rows, SORTS, of_run=run)


def neighbours_of(listing: Listing, example: int) -> dict[str, int | None]:
    """Return the examples before and after this one in the filtered list."""
    rows = listing.matching.order_by("example_id").values_list("example_id", flat=True)
    return {
        "before": rows.filter(example_id__lt=example).last(),
        "after": rows.filter(example_id__gt=example).first(),
    }
