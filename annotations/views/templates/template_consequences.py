"""What saving a template would do, shown beside it while it is written and said again after saving."""

from __future__ import annotations

import copy
from typing import Any

from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.consequence_presentation import groups_of
from annotations.forms import TemplateForm
from annotations.generation.consequences import TemplateChange, WorldConsequences, consequences
from annotations.models import Duty, SemanticTemplate, TaskCategory, World
from annotations.people.access import WRITE, world_view

MOST_DIGITS = 18  # of a key


@world_view(Duty.ANNOTATE, WRITE)
def template_consequences(request: HttpRequest, world: World) -> HttpResponse:
    """Show what saving the typed template would do, over the stored one that ``template`` names."""
    row = _find_row(world, request.GET.get("template", ""))
    expected = consequences_of_form(world, TemplateForm(world, request.POST), row)
    context = {"expected": expected, "groups": groups_of(expected) if expected else []}
    return render(request, "annotations/_change_consequences.html", context)


def _find_row(world: World, key: str) -> SemanticTemplate | None:
    """Return None for no key. Raises Http404 where the world has no template of that key."""
    if not key:
        return None
    if not key.isdecimal() or len(key) > MOST_DIGITS:
        raise Http404("No such template.")
    return get_object_or_404(SemanticTemplate, grammar__world=world, pk=int(key))


def consequences_of_form(
    world: World, form: TemplateForm, row: SemanticTemplate | None
) -> WorldConsequences | None:
    """Return what saving the form over ``row`` would do; of a new template where that is None.

    None while a side is empty. ``trouble`` where it has an error that keeps the template from being saved.
    """
    form.fields["task_category"].required = row is None
    form.is_valid()  # the template may be a draft, and then an error does not stop it
    values = {name: form[name].value() or "" for name in ("pattern", "form", "status")}
    category = form.chosen_category
    if not values["pattern"].strip() or not values["form"].strip() or category is None:
        return None
    if form.errors:
        return WorldConsequences(trouble="correct the errors first")
    if row:
        values |= row.moved_to(category)
    return consequences(world, change_to(row, category, values))


def change_to(
    row: SemanticTemplate | None, category: TaskCategory, values: dict[str, Any]
) -> TemplateChange:
    """Return the change that saving ``values`` over ``row`` is; of a new template where that is None."""
    after = copy.copy(row) if row else SemanticTemplate.for_category(category)
    for name, value in values.items():
        setattr(after, name, value)
    return TemplateChange(row, after)
