"""Delete a row of any kind, after a look at what changes with it."""

from __future__ import annotations

from django.contrib import messages
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.checking import check_deletion
from annotations.consequence_presentation import groups_of
from annotations.editing.edits import Overtaken, delete
from annotations.models import Duty, World
from annotations.people.access import READ_AND_WRITE, world_view
from annotations.views.editing.history import kind_named, number_in


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def delete_row(request: HttpRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Show what deleting a row does; a POST deletes what the reader saw at ``version``."""
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
        return render(request, "annotations/delete.html", context)
    try:
        delete(row, request.user, number_in(request.POST.get("version", "")) or 0)
    except Overtaken as error:
        messages.error(request, f"Not deleted. {error}")
        return here
    messages.success(request, f"Deleted. “Deleted {of_kind.plural}” below the list brings it back.")
    return redirect(of_kind.list_page, world=world.name)
