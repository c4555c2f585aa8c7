"""Predicates: listed, edited in place, each with its English sentence and the templates that it would break."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import Http404, HttpResponse
from django.shortcuts import redirect, render

from annotations.editing.edits import Overtaken, add
from annotations.generation.predicate_check import check_predicate
from annotations.models import Duty, Predicate, World
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.rows.from_rows import predicate_of
from annotations.rows.row_kinds import KINDS
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.paging import number_in
from annotations.web.description.description_filters import PredicateFilters
from annotations.web.description.predicate_forms import PredicateForm, initial_values
from annotations.web.editing.merge_pages import merge_page, save_edit
from annotations.web.forms import posted

SORTS = {"name": Sort("Predicate", "name"), "kind": Sort("Kind", "kind")}


@world_view(Duty.VIEW)
def predicates(request: WorldRequest, world: World) -> HttpResponse:
    """List the predicates with their arguments."""
    rows = world.predicates.all()
    context = {"listing": Listing(request, PredicateFilters, rows, SORTS, size=200)}
    return render_list(request, "annotations/description/predicates.html", context)


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def predicate(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show a predicate with its arguments and its English sentence. Annotators change it."""
    row, is_there = KINDS["predicate"].row_or_last_known(world, pk)
    if not is_there and request.method != "POST":
        return redirect("history", world=world.name, kind="predicate", pk=pk)
    form = PredicateForm(world, row, posted(request), initial=initial_values(row))
    if request.method == "POST" and form.is_valid():
        try:
            row = save_edit(request, row, form, form.values)
        except Overtaken as clash:
            return merge_page(request, row, form, clash, initial_values)
        messages.success(request, f"Saved as version {row.version}.")
        return redirect("predicate", world=world.name, pk=pk)
    context = {
        "row": row,
        "form": form,
        "checked": check_predicate(world, predicate_of(row)),
        "query": f"?predicate={row.pk}",
    }
    return render(request, "annotations/description/predicate.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def predicate_new(request: WorldRequest, world: World) -> HttpResponse:
    """Declare a predicate."""
    form = PredicateForm(world, None, posted(request))
    if request.method == "POST" and form.is_valid():
        unsaved = Predicate(world=world, name=form.cleaned_data["name"], **form.values)
        try:
            row = add(unsaved, request.user, form.cleaned_data["once"])
        except ValidationError:
            form.add_error("name", "There is a predicate of this name already. Edit that one.")
        else:
            messages.success(request, f"Added {row.name}.")
            return redirect("predicate", world=world.name, pk=row.pk)
    return render(request, "annotations/description/predicate.html", {"form": form})


@world_view(Duty.ANNOTATE, WRITE)
def predicate_preview(request: WorldRequest, world: World) -> HttpResponse:
    """Preview the typed predicate: its English sentence, and the templates that it would break."""
    key = request.GET.get("predicate", "")
    row = Predicate.objects.filter(world=world, pk=number_in(key)).first()
    if key and row is None:
        raise Http404("No such predicate.")
    form = PredicateForm(world, row, request.POST, initial=initial_values(row) if row else {})
    context: dict[str, Any] = {}
    if form.is_valid():
        context["checked"] = check_predicate(world, form.predicate)
    elif "signatures" in form.errors:
        context["trouble"] = form.errors["signatures"][0]
    return render(request, "annotations/description/_predicate_preview.html", context)
