"""Rename an entity, a nonterminal or a predicate, after a preview of everything that names it."""

from __future__ import annotations

from django.contrib import messages
from django.http import Http404, HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.edits import Overtaken
from annotations.editing.rename_plans import PLANS
from annotations.editing.world_rename import rename
from annotations.models import Duty, Editable, World
from annotations.people.access import READ_AND_WRITE, WorldRequest, world_view
from annotations.rows.row_kinds import EditableKind
from annotations.web.editing.kinds_of_rows import kind_named
from annotations.web.editing.rename_forms import RenameForm, names_of

WHAT = {"production": "nonterminal", "task_category": "task category"}


@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="rename everywhere")
def rename_row(request: WorldRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Preview a renaming. A POST carries it out."""
    of_kind = kind_named(kind)
    if of_kind.model not in PLANS:
        raise Http404("Rows of this kind have no name.")
    row, is_there = of_kind.row_or_last_known(world, pk)
    if not is_there:
        return redirect("history", world=world.name, kind=kind, pk=pk)
    sent = request.POST if request.method == "POST" else request.GET
    form = RenameForm(row, sent if "new" in sent else None)
    if request.method == "POST" and form.is_valid():
        try:
            names = form.cleaned_data["old"], form.cleaned_data["new"]
            touched = rename(row, *names, request.user, form.cleaned_data["version"] or 0)
        except Overtaken as error:
            form.add_error(None, f"{error.sentence} Look at the list again, then rename.")
        else:
            counts = ", ".join(changed.sentence for changed in touched)
            messages.success(request, f"Renamed in {counts}.")
            return redirect(_page_of(world, of_kind, row))
    is_valid = form.is_valid()
    context = {
        "kind": of_kind,
        "what": WHAT.get(of_kind.name, of_kind.name),
        "row": row,
        "name": names_of(row)[0],
        "form": form,
        "page": _page_of(world, of_kind, row),
        "n_rows": sum(map(len, form.touched)) if is_valid else 0,
    }
    if form.is_bound:
        form.data = {**request.POST.dict(), "version": row.version}
    status = 409 if request.method == "POST" and form.non_field_errors() else 200
    return render(request, "annotations/editing/rename.html", context, status=status)


def _page_of(world: World, kind: EditableKind, row: Editable) -> str:
    if kind.page:
        return reverse(kind.page, kwargs={"world": world.name, "pk": row.pk})
    return reverse(kind.list_page, kwargs={"world": world.name})
