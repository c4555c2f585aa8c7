"""The entities of a world: singly, and many at a time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpResponse
from django.shortcuts import redirect, render

from annotations.editing.edits import add_many
from annotations.language.texts import say_count
from annotations.models import Duty, Entity, World
from annotations.models.description import ProblemSubject
from annotations.people.access import READ_AND_WRITE, PageRequest, WorldRequest, world_view
from annotations.rows.from_rows import classes_of
from annotations.rows.occurrences import MOST_SHOWN, occurrences_of
from annotations.showing.listing import Listing, Sort
from annotations.web.description.description_filters import EntityFilters
from annotations.web.description.entity_forms import (
    EntitiesForm,
    EntityForm,
    ontology_in,
)
from annotations.web.editing.nouns import Noun
from annotations.web.forms import posted


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
        return asked_class(request)


ENTITIES = EntityNoun()


def counted_classes(world: World, counts: Mapping[str, int]) -> dict[str, int]:
    """Return the counts in the order of the world's classes, without those of no entity."""
    return {name: counts[name] for name in classes_of(world).tokens if name in counts}


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def entities_new(request: WorldRequest, world: World) -> HttpResponse:
    """Preview what the pasted lines would add. With ``add``, add all of them or none."""
    form = EntitiesForm(world, posted(request), initial=asked_class(request))
    context: dict[str, Any] = {"form": form}
    if request.method == "POST" and form.is_valid():
        additions = form.additions
        context["additions"] = additions
        if "add" in request.POST and additions.new and not additions.has_errors:
            try:
                count = add_many(unsaved_rows(world, form), request.user, form.cleaned_data["once"])
            except ValidationError as error:
                form.add_error("lines", error.messages)
            else:
                messages.success(request, f"Added {say_count(count, 'entity')}.")
                return redirect("ontology", world=world.name)
    return render(request, "annotations/description/entities_new.html", context)


def unsaved_rows(world: World, form: EntitiesForm) -> list[Entity]:
    ontology = ontology_in(world)
    return [
        Entity(
            ontology=ontology,
            entity_class=each.entity_class,
            text=each.text,
            aliases=list(each.aliases),
            attributes=dict(each.attributes),
        )
        for each in form.additions.new
    ]


def asked_class(request: PageRequest) -> dict[str, str]:
    return {"entity_class": request.GET.get("entity_class", "object")}
