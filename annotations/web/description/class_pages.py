"""The classes of entities: listed, added, edited in place, and the colours of their chips."""

from __future__ import annotations

from hashlib import sha256

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.db.models import QuerySet
from django.http import HttpResponse
from django.http.response import HttpResponseBase
from django.shortcuts import redirect, render
from django.utils.cache import get_conditional_response, patch_cache_control

from annotations.editing.edits import Overtaken, add
from annotations.generation.class_uses import count_uses
from annotations.models import Duty, Entity, EntityClass, World
from annotations.people.access import READ_AND_WRITE, WorldRequest, world_view
from annotations.rows.row_kinds import KINDS
from annotations.web.description.class_forms import EntityClassForm, initial_values
from annotations.web.editing.merge_pages import merge_page, save_edit
from annotations.web.forms import posted


@world_view(Duty.VIEW)
def entity_classes(request: WorldRequest, world: World) -> HttpResponse:
    """List the classes with the number of their entities."""
    counts = Entity.objects.filter(ontology__world=world).count_by_class()
    rows = [(row, counts.get(row.token, 0)) for row in world.entity_classes.all()]
    return render(request, "annotations/description/entity_classes.html", {"rows": rows})


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def entity_class(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show a class and what uses it. Annotators change it."""
    row, is_there = KINDS["entity_class"].row_or_last_known(world, pk)
    if not is_there and request.method != "POST":
        return redirect("history", world=world.name, kind="entity_class", pk=pk)
    form = EntityClassForm(world, row, posted(request), initial=initial_values(row))
    if request.method == "POST" and form.is_valid():
        try:
            row = save_edit(request, row, form, form.values)
        except Overtaken as clash:
            return merge_page(request, row, form, clash, initial_values)
        messages.success(request, f"Saved as version {row.version}.")
        return redirect("entity_class", world=world.name, pk=pk)
    context = {"row": row, "form": form, "uses": count_uses(row)}
    return render(request, "annotations/description/entity_class.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def entity_class_new(request: WorldRequest, world: World) -> HttpResponse:
    """Add a class."""
    form = EntityClassForm(world, None, posted(request))
    if request.method == "POST" and form.is_valid():
        unsaved = EntityClass(world=world, token=form.cleaned_data["token"], **form.values)
        try:
            row = add(unsaved, request.user, form.cleaned_data["once"])
        except ValidationError:
            form.add_error("token", "There is a class of this token already. Edit that one.")
        else:
            messages.success(request, f"Added {row.token}.")
            return redirect("entity_class", world=world.name, pk=row.pk)
    return render(request, "annotations/description/entity_class.html", {"form": form})


@world_view(Duty.VIEW)
def class_colours(request: WorldRequest, world: World) -> HttpResponseBase:
    """Give the colours of the classes as a style sheet, which the pages of the world link to."""
    css = "".join(_rules(world.entity_classes.all()))
    etag = f'W/"{sha256(css.encode()).hexdigest()[:32]}"'
    response = get_conditional_response(
        request, etag, response=HttpResponse(css, content_type="text/css; charset=utf-8")
    )
    assert response is not None  # the one that was given, or 304
    response["ETag"] = etag
    patch_cache_control(response, private=True, no_cache=True)
    return response


def _rules(rows: QuerySet[EntityClass]) -> list[str]:
    """Return a rule for each class. Tokens are letters and _, so that they need no escapes."""
    return [f'[data-class="{row.token}"] {{ --angle: {row.hue}; }}\n' for row in rows]
