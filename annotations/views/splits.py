"""Frozen splits: what parsers are trained and tested on."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.access import world_view
from annotations.filters import ExampleFilters
from annotations.listing import Listing, Sort
from annotations.models import Duty, Split, World
from annotations.parts import counts_of, leakage_of

SORTS = {
    "position": Sort("No.", "id", is_number=True),
    "utterance": Sort("Utterance", "utterance"),
    "category": Sort("Task category", "task_category"),
}


@world_view(Duty.VIEW)
def splits(request: HttpRequest, world: World) -> HttpResponse:
    """All splits with the number of their pairs by part and source."""
    rows = list(world.splits.select_related("created_by"))
    counts = counts_of(rows)
    context = {"rows": [(row, counts[row.pk]) for row in rows]}
    return render(request, "annotations/splits.html", context)


@world_view(Duty.VIEW)
def split(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """One split: its parts, what they share, its examples."""
    row = get_object_or_404(Split.objects.select_related("created_by"), world=world, pk=pk)
    context = {
        "split": row,
        "counts": counts_of([row])[row.pk],
        "leakage": leakage_of(row),
        "listing": Listing(request, ExampleFilters, row.examples.all(), SORTS),
    }
    return render(request, "annotations/split.html", context)
