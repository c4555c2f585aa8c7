"""Delete a row of any kind, after a look at what changes with it."""

from __future__ import annotations

from django.contrib import messages
from django.http import Http404, HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.edits import Overtaken, delete
from annotations.generation.deletion_check import check_deletion
from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.people.access import READ_AND_WRITE, WorldRequest, world_view
from annotations.showing.paging import number_in
from annotations.web.editing.consequence_presentation import groups_of
from annotations.web.editing.kinds_of_rows import DELETING, kind_named
from annotations.web.editing.undo import say_deleted


@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="delete")
def delete_row(request: WorldRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Preview the deletion of a row. A POST deletes it if it is still at ``version``."""
    of_kind = kind_named(kind)
    if not of_kind.is_deletable:
        raise Http404(f"{of_kind.plural.capitalize()} are not deleted.")
    row, is_there = of_kind.row_or_last_known(world, pk)
    here = redirect("history", world=world.name, kind=kind, pk=pk)
    if not is_there:
        return here
    if request.method != "POST":
        deletion = check_deletion(row)
        page = reverse(of_kind.page, kwargs={"world": world.name, "pk": pk})
        groups = groups_of(deletion.expected)
        context = {"kind": of_kind, "row": row, "page": page, "deletion": deletion}
        context |= {"expected": deletion.expected, "groups": groups}
        return render(request, "annotations/editing/delete.html", context)
    try:
        remove = DELETING.get(of_kind.model, delete)
        remove(row, request.user, number_in(request.POST.get("version", "")))
    except Overtaken as error:
        messages.error(request, f"Not deleted. {error.sentence} Look at it again.")
        return here
    except Refusal as error:
        messages.error(request, f"Not deleted. {error.message}")
        return redirect(of_kind.page, world=world.name, pk=pk)
    say_deleted(request, world, of_kind, pk)
    return redirect(of_kind.list_page, world=world.name)
