"""Give an entity, a nonterminal or a predicate another name, after a look at everything that names it."""

from __future__ import annotations

from django.contrib import messages
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.edits import Overtaken
from annotations.models import Duty, Editable, World
from annotations.people.access import READ_AND_WRITE, world_view
from annotations.renaming import PLANS, Touched, rename
from annotations.rows.kinds import Kind
from annotations.views.description.world_forms import RenameForm, names_of
from annotations.views.editing.history import kind_named

WHAT = {"production": "nonterminal"}


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def rename_row(request: HttpRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Show what another name changes; a POST changes it."""
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
            touched = _rename(request, row, form)
        except Overtaken as error:
            form.add_error(
                None, f"{error.args[0].split('.')[0]}. Look at the list again, then rename."
            )
        else:
            messages.success(request, f"Renamed in {_counts(touched)}.")
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
    form.data = {**form.data.dict(), "version": row.version} if form.is_bound else form.data
    status = 409 if request.method == "POST" and form.non_field_errors() else 200
    return render(request, "annotations/rename.html", context, status=status)


def _rename(request: HttpRequest, row: Editable, form: RenameForm) -> tuple[Touched, ...]:
    sent = form.cleaned_data
    return rename(row, sent["old"], sent["new"], request.user, sent["version"] or 0)


def _counts(touched: tuple[Touched, ...]) -> str:
    return ", ".join(each.sentence for each in touched)


def _page_of(world: World, kind: Kind, row: Editable) -> str:
    if kind.page:
        return reverse(kind.page, kwargs={"world": world.name, "pk": row.pk})
    return reverse(kind.list_page, kwargs={"world": world.name})
