"""The utterances of a world: the list, one with all answers to it, and a page that adds some."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.forms import UtterancesForm, posted
from annotations.labelling import collect
from annotations.language.english import say_count
from annotations.lists.filters import UtteranceFilters
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import Duty, World
from annotations.people.access import READ_AND_WRITE, world_view

SORTS = {
    "number": Sort("No.", "id", is_number=True),
    "text": Sort("Utterance", "text"),
    "status": Sort("Status", "status"),
}


@world_view(Duty.VIEW)
def utterances(request: HttpRequest, world: World) -> HttpResponse:
    """List what people said, with the form that it has."""
    rows = world.utterances.select_related("created_by")
    listing = Listing(request, UtteranceFilters, rows, SORTS)
    return render_list(request, "annotations/utterances.html", {"listing": listing})


@world_view(Duty.VIEW)
def utterance(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Show one utterance, its form and every answer to it, taken back or not."""
    row = get_object_or_404(world.utterances.select_related("created_by"), pk=pk)
    accepted = row.accepted_label
    labels = row.labels.select_related("annotator").order_by("-pk")
    if accepted is None:  # others may still be asked, and must not see what the first one said
        labels = labels.filter(annotator=request.user)
    context = {"row": row, "labels": labels, "accepted": accepted}
    return render(request, "annotations/utterance.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def utterances_new(request: HttpRequest, world: World) -> HttpResponse:
    """Take utterances in, pasted or as a text file: all of them, or none where one is wrong."""
    form = UtterancesForm(posted(request), request.FILES or None)
    collected = None
    if form.is_bound and form.is_valid():
        collected = collect(world, form.lines, form.origin, request.user)
        if not collected.problems and not collected.duplicates:
            added = say_count(collected.added, "utterance")
            messages.success(request, f"{added} added.")
            return redirect("label", world=world.name)
        if not collected.problems:
            form = UtterancesForm()  # what was sent is stored
    is_refused = bool(form.is_bound and form.errors) or bool(collected and collected.problems)
    context = {"form": form, "collected": collected}
    status = 422 if is_refused else 200
    return render(request, "annotations/utterances_new.html", context, status=status)
