"""Send the examples of a list of answers back to annotators."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404

from annotations.models import Duty, World
from annotations.people.access import WRITE, world_view
from annotations.views.queueing.sending import go_back, send
from parser_service.models import TrainingRun
from parser_service.views.reviewing.predictions import listing_of


@world_view(Duty.REVIEW, WRITE)
def predictions_send(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Put what is behind the answers that pass the filters of the URL into the work queue."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    rows = listing_of(request, run).matching.order_by("example_id")
    examples = (row.example for row in rows.iterator(chunk_size=500))
    send(request, world, examples)
    return go_back(request, "predictions", world=world.name, pk=pk)
