"""Frozen splits: what parsers are trained and tested on."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.access import READ_AND_WRITE, world_view
from annotations.filters import ExampleFilters
from annotations.forms import SplitForm, posted
from annotations.freezing import freeze_split, plan_split
from annotations.language.errors import LanguageError
from annotations.listing import Listing, Sort
from annotations.models import Duty, Split, World
from annotations.parts import counts_of, counts_of_planned, leakage_of, near_duplicates_of

SORTS = {
    "position": Sort("No.", "id", is_number=True),
    "utterance": Sort("Utterance", "utterance"),
    "category": Sort("Task category", "task_category"),
}
MOST_SHOWN = 100


@world_view(Duty.VIEW)
def splits(request: HttpRequest, world: World) -> HttpResponse:
    """All splits with the number of their pairs by part and source."""
    rows = list(world.splits.select_related("created_by"))
    counts = counts_of(rows)
    context = {"rows": [(row, counts[row.pk]) for row in rows]}
    return render(request, "annotations/splits.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def split_new(request: HttpRequest, world: World) -> HttpResponse:
    """The form that freezes a split; its other button only counts what would come out."""
    initial = {"name": f"{world.name}-{world.splits.count() + 1}"}
    form = SplitForm(posted(request), initial=initial)
    context = {"form": form}
    if form.is_bound and form.is_valid():
        try:
            if "preview" in request.POST:
                context["counts"] = counts_of_planned(plan_split(world, **form.choice))
            else:
                name = form.cleaned_data["name"]
                made = freeze_split(world, name, by=request.user, **form.choice)
                return redirect("split", world=world.name, pk=made.pk)
        except LanguageError as error:
            form.add_error(None, str(error))
    return render(request, "annotations/split_new.html", context)


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


@world_view(Duty.VIEW)
def near_duplicates(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Utterances that training nearly has; a part of the split's page, fetched when it is opened."""
    row = get_object_or_404(Split.objects.select_related("world"), world=world, pk=pk)
    context: dict[str, object] = {"most": MOST_SHOWN}
    try:
        context["parts"] = [
            (each.leak, each.found[:MOST_SHOWN], len(each.found))
            for each in near_duplicates_of(row)
        ]
    except LanguageError as error:
        context["refusal"] = error.problem
    return render(request, "annotations/_near_duplicates.html", context)
