"""The classes of entities: listed, added, edited in place, and the colours of their chips."""

from __future__ import annotations

from hashlib import sha256

from django.db.models import QuerySet
from django.http import HttpResponse
from django.http.response import HttpResponseBase
from django.shortcuts import render
from django.utils.cache import get_conditional_response, patch_cache_control

from annotations.models import Duty, Entity, EntityClass, World
from annotations.people.access import WorldRequest, world_view


@world_view(Duty.VIEW)
def entity_classes(request: WorldRequest, world: World) -> HttpResponse:
    """List the classes with the number of their entities."""
    counts = Entity.objects.filter(ontology__world=world).count_by_class()
    rows = [(row, counts.get(row.token, 0)) for row in world.entity_classes.all()]
    return render(request, "annotations/description/entity_classes.html", {"rows": rows})


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
