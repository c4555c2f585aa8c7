"""History of a row: its versions with their differences, and deleted rows. Both can be restored."""

from __future__ import annotations

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.edits import restore
from annotations.editing.row_versions import history_of_row
from annotations.labelling.label_answers import NoLongerYours
from annotations.models import Duty, World
from annotations.people.access import READ_AND_WRITE, WorldRequest, demand, world_view
from annotations.rows.row_kinds import EditableKind
from annotations.showing.paging import number_in
from annotations.web.editing.kinds_of_rows import RESTORING, kind_named

DELETED_SHOWN = 50


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE, does="restore a version")
def history(request: WorldRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Show the versions of a row; a POST restores the one that ``entry`` names."""
    of_kind = kind_named(kind)
    row, is_there = of_kind.row_or_last_known(world, pk)
    if request.method == "POST":
        demand(request, of_kind.write_duty)
        restore_entry(request, world, of_kind, pk)
        return redirect("history", world=world.name, kind=kind, pk=pk)
    page = of_kind.page and reverse(of_kind.page, kwargs={"world": world.name, "pk": pk})
    context = {
        "kind": of_kind,
        "row": row,
        "is_there": is_there,
        "page": page if is_there else "",
        "may_restore": of_kind.write_duty in request.duties,
        "history": history_of_row(
            of_kind, world, pk, number_in(request.GET.get("before", "")) or None
        ),
    }
    return render(request, "annotations/editing/history.html", context)


@world_view(Duty.VIEW)
def deleted(request: WorldRequest, world: World, kind: str) -> HttpResponse:
    """List the rows of a kind that were deleted, the latest first."""
    of_kind = kind_named(kind)
    entries = of_kind.deletions_in(world)
    if before := number_in(request.GET.get("before", "")):
        entries = entries.filter(history_id__lt=before)
    some = list(entries[: DELETED_SHOWN + 1])
    shown = some[:DELETED_SHOWN]
    context = {
        "kind": of_kind,
        "entries": [(entry, str(entry.instance)) for entry in shown],
        "older": shown[-1].history_id if len(some) > DELETED_SHOWN else None,
    }
    return render(request, "annotations/editing/deleted.html", context)


def restore_entry(request: WorldRequest, world: World, kind: EditableKind, pk: int) -> None:
    """Restore the version that was sent as ``entry``, and say what came of it."""
    number = number_in(request.POST.get("entry", ""))
    entry = kind.entries_of(world).filter(id=pk, history_id=number).first()
    if entry is None:
        messages.error(request, "That version is not there. Choose one of the list.")
        return
    try:
        row = RESTORING.get(kind.model, restore)(entry, request.user)
    except ValidationError as error:
        messages.error(request, f"Not restored. {' '.join(error.messages)}")
    except NoLongerYours as error:
        messages.error(request, f"Not restored. {error}")
    else:
        messages.success(request, f"Restored as version {row.version}.")
