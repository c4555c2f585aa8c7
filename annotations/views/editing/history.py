"""What became of a row: its versions with their differences, and what was deleted. Both can be restored."""

from __future__ import annotations

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.edits import restore
from annotations.editing.versions import history_of_row
from annotations.labelling import restore_utterance
from annotations.models import Duty, Utterance, World
from annotations.people.access import READ_AND_WRITE, world_view
from annotations.rows.kinds import KINDS, Kind

DELETED_SHOWN = 50
MOST_DIGITS = 18  # of the key of a history entry
RESTORING = {Utterance: restore_utterance}  # what more than the row itself is restored with


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def history(request: HttpRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Show the versions of a row; a POST restores the one that ``entry`` names."""
    of_kind = kind_named(kind)
    row, is_there = of_kind.row_or_last_known(world, pk)
    if request.method == "POST":
        restore_entry(request, world, of_kind, pk)
        return redirect("history", world=world.name, kind=kind, pk=pk)
    page = of_kind.page and reverse(of_kind.page, kwargs={"world": world.name, "pk": pk})
    context = {
        "kind": of_kind,
        "row": row,
        "is_there": is_there,
        "page": page if is_there else "",
        "history": history_of_row(of_kind, world, pk, number_in(request.GET.get("before", ""))),
    }
    return render(request, "annotations/history.html", context)


@world_view(Duty.VIEW)
def deleted(request: HttpRequest, world: World, kind: str) -> HttpResponse:
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
    return render(request, "annotations/deleted.html", context)


def restore_entry(request: HttpRequest, world: World, kind: Kind, pk: int) -> None:
    """Restore the version that was sent as ``entry``, and say what came of it."""
    number = number_in(request.POST.get("entry", ""))
    entry = kind.entries_of(world).filter(id=pk, history_id=number or 0).first()
    if entry is None:
        messages.error(request, "That version is not there. Choose one of the list.")
        return
    try:
        row = RESTORING.get(kind.model, restore)(entry, request.user)
    except ValidationError as error:
        messages.error(request, f"Not restored. {' '.join(error.messages)}")
    else:
        messages.success(request, f"Restored as version {row.version}.")


def kind_named(name: str) -> Kind:
    """Return the kind of that name. Raises Http404."""
    if name not in KINDS:
        raise Http404("There is no such kind of row.")
    return KINDS[name]


def number_in(text: str) -> int | None:
    """Return the whole number that ``text`` is, None where it is none or too large for a key."""
    is_number = text.isascii() and text.isdigit() and len(text) <= MOST_DIGITS
    return int(text) if is_number else None
