"""One entity: where it occurs, edited in place; new ones, singly and many at a time."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render

from annotations.editing.edits import Overtaken, add, add_many
from annotations.editing.once import made_before
from annotations.forms import posted
from annotations.language.english import say_count
from annotations.language.errors import Problem
from annotations.models import Duty, Editable, Entity, Ontology, World
from annotations.people.access import READ_AND_WRITE, world_view
from annotations.rows.kinds import KINDS, as_text
from annotations.rows.occurrences import MOST_SHOWN, occurrences_of
from annotations.views.description.world_forms import EntitiesForm, EntityForm
from annotations.views.editing.merging import merge_page, save_edit


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def entity(request: HttpRequest, world: World, pk: int) -> HttpResponse:
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
        tell_saved(request, f"Saved as version {row.version}.", problems)
        return redirect("entity", world=world.name, pk=pk)
    context = {"row": row, "form": form, "occurrences": occurrences_of(row), "most": MOST_SHOWN}
    return render(request, "annotations/entity.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def entity_new(request: HttpRequest, world: World) -> HttpResponse:
    """Add one entity."""
    form = EntityForm(world, None, posted(request), initial=asked_class(request))
    if request.method == "POST" and form.is_valid() and is_new(request, form):
        problems = form.additions.problems
        unsaved = Entity(ontology=ontology_in(world), **form.values)
        row = add(unsaved, request.user, form.cleaned_data["once"])
        tell_saved(request, f"Added {row.text}.", problems)
        return redirect("entity", world=world.name, pk=row.pk)
    return render(request, "annotations/entity_new.html", {"form": form})


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def entities_new(request: HttpRequest, world: World) -> HttpResponse:
    """Show what pasted lines would add; with ``add`` they are added, all of them or none."""
    form = EntitiesForm(world, posted(request), initial=asked_class(request))
    context: dict[str, Any] = {"form": form}
    if request.method == "POST" and form.is_valid():
        additions = form.additions
        context["additions"] = additions
        if "add" in request.POST and additions.new and not additions.has_errors:
            count = add_many(unsaved_rows(world, form), request.user, form.cleaned_data["once"])
            messages.success(request, f"Added {say_count(count, 'entity')}.")
            return redirect("ontology", world=world.name)
    return render(request, "annotations/entities_new.html", context)


def is_new(request: HttpRequest, form: EntityForm) -> bool:
    """Return whether no entity says the same, or the form was sent twice; the form says so otherwise."""
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


def ontology_in(world: World) -> Ontology:
    return Ontology.objects.get_or_create(world=world)[0]


def asked_class(request: HttpRequest) -> dict[str, str]:
    return {"entity_class": request.GET.get("entity_class", "object")}


def initial_values(row: Editable) -> dict[str, Any]:
    """Return what the fields of the form show for ``row``."""
    names = ("entity_class", "text", "aliases", "attributes", "version")
    return {name: as_text(getattr(row, name)) for name in names}


def tell_saved(request: HttpRequest, sentence: str, problems: tuple[Problem, ...]) -> None:
    """Say that something was saved, and what the checker says of it now."""
    if not problems:
        messages.success(request, sentence)
        return
    remarks = " ".join(f"{each.message[:1].upper()}{each.message[1:]}." for each in problems)
    messages.warning(request, f"{sentence} {remarks}")
