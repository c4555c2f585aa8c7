"""One predicate: edited in place, with its English sentence and the templates that it would break."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render

from annotations.checking import check_predicate
from annotations.editing.edits import Overtaken, add
from annotations.forms import posted
from annotations.language.predicates import print_signatures
from annotations.models import Duty, Editable, Predicate, World
from annotations.people.access import READ_AND_WRITE, WRITE, world_view
from annotations.rows.from_rows import predicate_of
from annotations.rows.kinds import KINDS
from annotations.views.description.predicate_forms import PredicateForm
from annotations.views.editing.history import number_in
from annotations.views.editing.merging import merge_page, save_edit


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def predicate(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Show a predicate, what it takes and how it sounds; annotators change it."""
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
    return render(request, "annotations/predicate.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def predicate_new(request: HttpRequest, world: World) -> HttpResponse:
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
    return render(request, "annotations/predicate.html", {"form": form})


@world_view(Duty.ANNOTATE, WRITE)
def predicate_preview(request: HttpRequest, world: World) -> HttpResponse:
    """Show what the typed predicate sounds like and which templates it leaves with a problem."""
    key = request.GET.get("predicate", "")
    row = Predicate.objects.filter(world=world, pk=number_in(key) or 0).first()
    if key and row is None:
        raise Http404("No such predicate.")
    form = PredicateForm(world, row, request.POST, initial=initial_values(row) if row else {})
    context: dict[str, Any] = {}
    if form.is_valid():
        context["checked"] = check_predicate(world, form.predicate)
    elif "signatures" in form.errors:
        context["trouble"] = form.errors["signatures"][0]
    return render(request, "annotations/_predicate_preview.html", context)


def initial_values(row: Editable) -> dict[str, Any]:
    """Return what the fields of the form show for ``row``."""
    value = predicate_of(row)
    names = ("name", "kind", "gloss", "version")
    return {
        **{name: getattr(row, name) for name in names},
        "signatures": print_signatures(value.signatures),
    }
