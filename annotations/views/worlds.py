"""Making a world."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render

from annotations.access import READ_AND_WRITE, site_view
from annotations.forms import WorldForm, posted


@site_view(READ_AND_WRITE)
def world_new(request: HttpRequest) -> HttpResponse:
    """A new, empty world; its files come next."""
    form = WorldForm(posted(request))
    if form.is_bound and form.is_valid():
        made = form.save()
        return redirect("import", world=made.name)
    return render(request, "annotations/world_new.html", {"form": form})
