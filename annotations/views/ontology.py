"""The things a world is about."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import render

from annotations.access import world_view
from annotations.filters import EntityFilters
from annotations.listing import Listing, Sort
from annotations.models import Duty, Entity, World
from annotations.models.problems import Subject

SORTS = {
    "position": Sort("File", "position"),
    "text": Sort("Name", "text"),
    "class": Sort("Class", "entity_class"),
}


@world_view(Duty.VIEW)
def ontology(request: HttpRequest, world: World) -> HttpResponse:
    """The entities by class, and what the checker says of their files."""
    entities = Entity.objects.filter(ontology__world=world)
    context = {
        "listing": Listing(request, EntityFilters, entities, SORTS, size=100),
        "classes": entities.count_by_class(),
        "problems": world.problems.filter(subject=Subject.ONTOLOGY),
    }
    return render(request, "annotations/ontology.html", context)


@world_view(Duty.VIEW)
def predicates(request: HttpRequest, world: World) -> HttpResponse:
    """What logical forms are made of."""
    context = {"predicates": world.predicates.all()}
    return render(request, "annotations/predicates.html", context)
