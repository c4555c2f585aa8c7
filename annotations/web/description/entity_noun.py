"""The entities of a world."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.http import HttpResponse
from django.shortcuts import render

from annotations.models import Entity, EntityClass, World
from annotations.models.description import ProblemSubject
from annotations.people.access import PageRequest, WorldRequest
from annotations.rows.from_rows import classes_of
from annotations.rows.occurrences import MOST_SHOWN, occurrences_of
from annotations.showing.listing import Listing, Sort
from annotations.web.description.description_filters import EntityFilters
from annotations.web.description.entity_forms import EntityForm
from annotations.web.editing.nouns import Noun


class EntityNoun(Noun):
    form = EntityForm
    template = "annotations/description/entity.html"
    new_template = "annotations/description/entity_new.html"
    list_template = "annotations/description/ontology.html"
    filters = EntityFilters
    sorts = {
        "position": Sort("File", "position"),
        "text": Sort("Name", "text"),
        "class": Sort("Class", "entity_class"),
    }
    page_size = 100

    def context(
        self, request: WorldRequest, world: World, row: Any | None, form: EntityForm
    ) -> Mapping[str, Any]:
        return {"occurrences": occurrences_of(row), "most": MOST_SHOWN} if row else {}

    def list_context(self, world: World, listing: Listing) -> Mapping[str, Any]:
        """Return the number of entities by class, and what the checker says of their files."""
        counts = Entity.objects.filter(ontology__world=world).count_by_class()
        return {
            "classes": counted_classes(world, counts),
            "problems": world.problems.filter(subject=ProblemSubject.ONTOLOGY),
        }

    def asked(self, request: WorldRequest, world: World) -> Mapping[str, Any]:
        return asked_class(request, world)

    def alike(self, row: Entity) -> Mapping[str, str]:
        return {"entity_class": row.entity_class}

    def missing(self, request: WorldRequest, world: World) -> HttpResponse | None:
        return needs_class(request, world)


ENTITIES = EntityNoun()


def counted_classes(world: World, counts: Mapping[str, int]) -> dict[str, int]:
    """Return the counts in the order of the world's classes, without those of no entity."""
    return {name: counts[name] for name in classes_of(world).tokens if name in counts}


def asked_class(request: PageRequest, world: World) -> dict[str, str]:
    """Return the class that the address names, or else the first one."""
    return {"entity_class": request.GET.get("entity_class") or next(iter(classes_of(world).tokens))}


def needs_class(request: PageRequest, world: World) -> HttpResponse | None:
    """Return the page that offers classes where a world has none, so that no entity can be added; None elsewhere."""
    if world.entity_classes.exists():
        return None
    context = {"missing": EntityClass.objects.missing_of_household(world)}
    return render(request, "annotations/description/entity_needs_class.html", context)
