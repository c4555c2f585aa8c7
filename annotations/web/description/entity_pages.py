"""The entities of a world: listed, edited in place, added singly and many at a time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpResponse
from django.shortcuts import redirect, render

from annotations.editing.edits import Overtaken, add, add_many
from annotations.editing.once_keys import made_before
from annotations.language.texts import Problem, say_count
from annotations.models import Duty, Entity, World
from annotations.models.description import ProblemSubject
from annotations.people.access import READ_AND_WRITE, PageRequest, WorldRequest, world_view
from annotations.rows.from_rows import classes_of
from annotations.rows.occurrences import MOST_SHOWN, occurrences_of
from annotations.rows.row_kinds import KINDS
from annotations.showing.listing import Listing, Sort, render_list
from annotations.web.description.description_filters import EntityFilters
from annotations.web.description.entity_forms import (
    EntitiesForm,
    EntityForm,
    initial_values,
    ontology_in,
)
from annotations.web.editing.merge_pages import merge_page, save_edit
from annotations.web.forms import posted

SORTS = {
    "position": Sort("File", "position"),
    "text": Sort("Name", "text"),
    "class": Sort("Class", "entity_class"),
}


@world_view(Duty.VIEW)
def ontology(request: WorldRequest, world: World) -> HttpResponse:
    """List the entities, their number by class, and what the checker says of their files."""
    entities = Entity.objects.filter(ontology__world=world)
    context = {
        "listing": Listing(request, EntityFilters, entities, SORTS, size=100),
        "classes": counted_classes(world, entities.count_by_class()),
        "problems": world.problems.filter(subject=ProblemSubject.ONTOLOGY),
    }
    return render_list(request, "annotations/description/ontology.html", context)


def counted_classes(world: World, counts: Mapping[str, int]) -> dict[str, int]:
    """Return the counts in the order of the world's classes, without those of no entity."""
    return {name: counts[name] for name in classes_of(world).tokens if name in counts}


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def entity(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one entity and where it occurs; annotators change it."""
    row, is_there = KINDS["entity"].row_or_last_known(world, pk)
    if not is_there and request.method != "POST":
        return redirect("history", world=world.name, kind="entity", pk=pk)
    form = EntityForm(world, row, posted(request), initial=initial_values(row))
    if request.method == "POST" and form.is_valid():
        problems = form.additions.problems
        try:
            row = save_edit(request, row, form, form.values)
        except Overtaken as clash:
            return merge_page(request, row, form, clash, initial_values)
        except ValidationError as error:
            form.add_error(None, error)
        else:
            tell_saved(request, f"Saved as version {row.version}.", problems)
            return redirect("entity", world=world.name, pk=pk)
    context = {"row": row, "form": form, "occurrences": occurrences_of(row), "most": MOST_SHOWN}
    return render(request, "annotations/description/entity.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def entity_new(request: WorldRequest, world: World) -> HttpResponse:
    """Add one entity."""
    form = EntityForm(world, None, posted(request), initial=asked_class(request))
    if request.method == "POST" and form.is_valid() and is_new(request, form):
        problems = form.additions.problems
        unsaved = Entity(ontology=ontology_in(world), **form.values)
        try:
            row = add(unsaved, request.user, form.cleaned_data["once"])
        except ValidationError as error:
            form.add_error("text", error.messages)
        else:
            tell_saved(request, f"Added {row.text}.", problems)
            return redirect("entity", world=world.name, pk=row.pk)
    return render(request, "annotations/description/entity_new.html", {"form": form})


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


def is_new(request: PageRequest, form: EntityForm) -> bool:
    """Return whether the entity is new, or the same form was sent twice. Otherwise add an error to the form."""
    if made_before(request.user, form.cleaned_data["once"]) or not form.additions.duplicates:
        return True
    form.add_error("text", "This entity is there already.")
    return False


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


def tell_saved(request: PageRequest, sentence: str, problems: tuple[Problem, ...]) -> None:
    """Tell the reader that it was saved, with the checker's problems."""
    if not problems:
        messages.success(request, sentence)
        return
    remarks = " ".join(f"{each.message[:1].upper()}{each.message[1:]}." for each in problems)
    messages.warning(request, f"{sentence} {remarks}")
