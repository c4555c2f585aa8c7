"""Lists of templates that need a repair, each row with what can be done about it."""

from __future__ import annotations

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.editing.edits import Overtaken, change, delete
from annotations.generation.conflicts import conflicts_of
from annotations.generation.suggesting import moved_form
from annotations.generation.template_check import check_template
from annotations.models import Duty, SemanticTemplate, TaskCategory, World
from annotations.people.access import WRITE, WorldRequest, world_view
from annotations.rows.row_kinds import KINDS
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.paging import number_in
from annotations.web.description.description_filters import TemplateFilters, with_counts
from annotations.web.editing.undo import say_deleted

SORTS = {
    "position": Sort("Task category", "position"),
    "pattern": Sort("Pattern", "pattern"),
}
LISTS = ("unmatched", "conflicts", "outside_grammar")


@world_view(Duty.VIEW)
def unmatched(request: WorldRequest, world: World) -> HttpResponse:
    """List the templates that give no command of the grammar its form."""
    rows = with_counts(world).filter(n_inside=0)
    context = {"listing": Listing(request, TemplateFilters, rows, SORTS), "current": "unmatched"}
    return render_list(request, "annotations/description/template_repairs.html", context)


@world_view(Duty.VIEW)
def outside_grammar(request: WorldRequest, world: World) -> HttpResponse:
    """List the templates that make commands outside the grammar, with one of these."""
    rows = with_counts(world).filter(n_outside__gt=0)
    listing = Listing(request, TemplateFilters, rows, SORTS)
    context = {"listing": listing, "current": "outside_grammar"}
    return render_list(request, "annotations/description/template_repairs.html", context)


@never_cache
@world_view(Duty.VIEW)
def conflicts(request: WorldRequest, world: World) -> HttpResponse:
    """List the pairs of templates that give one command different forms."""
    context = {"report": conflicts_of(world), "current": "conflicts"}
    return render(request, "annotations/description/conflicts.html", context)


@world_view(Duty.ANNOTATE, WRITE, does="repair a template")
def template_repair(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Delete a template, move it to another task category, or give it the form of another template."""
    row = get_object_or_404(SemanticTemplate, grammar__world=world, pk=pk)
    version = number_in(request.POST.get("version", ""))
    try:
        if request.POST.get("form_of"):
            _take_form(request, world, row, version)
        elif request.POST.get("move_to"):
            key = number_in(request.POST["move_to"])
            category = get_object_or_404(TaskCategory, grammar__world=world, pk=key)
            checked = check_template(world, category, row.pattern, row.form)
            values = {**row.moved_to(category), "problems": checked.stored_problems}
            change(row, values, request.user, version)
            messages.success(request, f"Moved to task category {category.name}.")
            return redirect("template", world=world.name, pk=pk)
        else:
            delete(row, request.user, version)
            say_deleted(request, world, KINDS["template"], pk)
    except Overtaken as error:
        messages.error(request, f"{error.sentence} Nothing was changed here.")
    except ValidationError as error:
        messages.error(request, f"Not changed. {' '.join(error.messages)}")
    asked = request.POST.get("list", "")
    return redirect(asked if asked in LISTS else LISTS[0], world=world.name)


def _take_form(request: WorldRequest, world: World, row: SemanticTemplate, version: int) -> None:
    """Give ``row`` the form of the template that was sent as ``form_of``, if it fits its pattern."""
    key = number_in(request.POST["form_of"])
    other = get_object_or_404(SemanticTemplate, grammar__world=world, pk=key)
    category = TaskCategory.objects.filter(grammar__world=world, name=row.task_category).first()
    form = moved_form(category, other, row) if category else other.form
    checked = check_template(world, category, row.pattern, form)
    if checked.has_errors:
        problem = next(each for each in checked.problems if each.is_error)
        messages.error(request, f"That form does not fit this pattern: {problem.message}.")
        return
    values = {"form": form, "problems": checked.stored_problems}
    change(row, values, request.user, version)
    messages.success(request, "Both templates have this form now.")
