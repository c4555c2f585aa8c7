"""The classes of entities: listed, added, edited in place, and the colours of their chips."""

from __future__ import annotations

from collections.abc import Mapping
from hashlib import sha256
from typing import Any

from django.db.models import QuerySet
from django.http import HttpResponse
from django.http.response import HttpResponseBase
from django.shortcuts import render
from django.utils.cache import get_conditional_response, patch_cache_control

from annotations.generation.class_uses import count_uses
from annotations.models import Duty, Entity, EntityClass, World
from annotations.people.access import WorldRequest, world_view
from annotations.web.description.class_forms import EntityClassForm
from annotations.web.editing.nouns import Noun


@world_view(Duty.VIEW)
def entity_classes(request: WorldRequest, world: World) -> HttpResponse:
    """List the classes with the number of their entities."""
    counts = Entity.objects.filter(ontology__world=world).count_by_class()
    rows = [(row, counts.get(row.token, 0)) for row in world.entity_classes.all()]
    return render(request, "annotations/description/entity_classes.html", {"rows": rows})


class EntityClassNoun(Noun):
    form = EntityClassForm
    template = "annotations/description/entity_class.html"

    def context(
        self, request: WorldRequest, world: World, row: Any | None, form: EntityClassForm
    ) -> Mapping[str, Any]:
        return {"uses": count_uses(row)} if row else {}


ENTITY_CLASSES = EntityClassNoun()


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
