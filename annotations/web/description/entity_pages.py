"""The entities of a world: singly, and many at a time."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpResponse
from django.shortcuts import redirect, render

from annotations.editing.edits import add_many
from annotations.language.texts import say_count
from annotations.models import Duty, Entity, World
from annotations.people.access import READ_AND_WRITE, WorldRequest, world_view
from annotations.web.description.entity_forms import (
    EntitiesForm,
    ontology_in,
)
from annotations.web.description.entity_noun import asked_class, needs_class
from annotations.web.forms import posted


@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="add entities")
def entities_new(request: WorldRequest, world: World) -> HttpResponse:
    """Preview what the pasted lines would add. With ``add``, add all of them or none."""
    if lacking := needs_class(request, world):
        return lacking
    form = EntitiesForm(world, posted(request), initial=asked_class(request, world))
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
