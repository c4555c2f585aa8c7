"""The task categories in order, which a POST changes."""

from __future__ import annotations

from django.contrib import messages
from django.db.models import Count
from django.http import HttpResponse
from django.shortcuts import redirect, render

from annotations.editing.task_categories import order_categories
from annotations.language.texts import Refusal
from annotations.models import Duty, SemanticTemplate, World
from annotations.people.access import READ_AND_WRITE, WorldRequest, world_view
from annotations.showing.paging import number_in
from annotations.web.description.category_forms import categories_of


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE, does="order the task categories")
def task_categories(request: WorldRequest, world: World) -> HttpResponse:
    """List the task categories. A POST moves the one called ``up`` before the one above it."""
    rows = list(categories_of(world))
    if request.method == "POST":
        keys = [row.pk for row in rows]
        moved = number_in(request.POST.get("up", ""))
        if moved in keys[1:]:
            at = keys.index(moved)
            keys[at - 1 : at + 1] = [moved, keys[at - 1]]
            try:
                order_categories(world, keys, request.user)
            except Refusal as error:
                messages.error(request, error.message)
        return redirect("task_categories", world=world.name)
    templates = SemanticTemplate.objects.filter(grammar__world=world).order_by()
    counted = templates.values_list("task_category").annotate(Count("pk"))
    context = {"rows": [(row, dict(counted).get(row.name, 0)) for row in rows]}
    return render(request, "annotations/description/task_categories.html", context)
