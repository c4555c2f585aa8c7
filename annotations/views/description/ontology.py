"""The entities of a world, and the predicates of its logical forms."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse

from annotations.lists.filters import EntityFilters, PredicateFilters
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import Duty, Entity, World
from annotations.models.description import Subject
from annotations.people.access import world_view

SORTS = {
    "position": Sort("File", "position"),
    "text": Sort("Name", "text"),
    "class": Sort("Class", "entity_class"),
}
PREDICATE_SORTS = {"name": Sort("Predicate", "name"), "kind": Sort("Kind", "kind")}


@world_view(Duty.VIEW)
def ontology(request: HttpRequest, world: World) -> HttpResponse:
    """List the entities, their number by class, and what the checker says of their files."""
    entities = Entity.objects.filter(ontology__world=world)
    context = {
        "listing": Listing(request, EntityFilters, entities, SORTS, size=100),
        "classes": entities.count_by_class(),
        "problems": world.problems.filter(subject=Subject.ONTOLOGY),
    }
    return render_list(request, "annotations/ontology.html", context)


@world_view(Duty.VIEW)
def predicates(request: HttpRequest, world: World) -> HttpResponse:
    """List the predicates with their arguments."""
    rows = world.predicates.all()
    context = {"listing": Listing(request, PredicateFilters, rows, PREDICATE_SORTS, size=200)}
    return render_list(request, "annotations/predicates.html", context)
