"""The classes of entities: listed, added, edited in place, and the colours of their chips."""

from __future__ import annotations

from hashlib import sha256

from django.contrib import messages
from django.db.models import QuerySet
from django.http import HttpResponse
from django.http.response import HttpResponseBase
from django.shortcuts import redirect, render
from django.utils.cache import get_conditional_response, patch_cache_control

from annotations.editing.household_classes import add_household
from annotations.language.texts import say_count
from annotations.models import Duty, Entity, EntityClass, World
from annotations.people.access import WRITE, WorldRequest, world_view


@world_view(Duty.VIEW)
def entity_classes(request: WorldRequest, world: World) -> HttpResponse:
    """List the classes with the number of their entities."""
    counts = Entity.objects.filter(ontology__world=world).count_by_class()
    rows = [(row, counts.get(row.token, 0)) for row in world.entity_classes.all()]
    missing = EntityClass.objects.missing_of_household(world)
    context = {"rows": rows, "missing": missing}
    return render(request, "annotations/description/entity_classes.html", context)


@world_view(Duty.ANNOTATE, WRITE, does="add the classes of a household")
def classes_of_household(request: WorldRequest, world: World) -> HttpResponse:
    """Add those classes of a household that the world has not got."""
    messages.success(request, f"Added {say_count(add_household(world, request.user), 'class')}.")
    return redirect("entity_classes", world=world.name)


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
