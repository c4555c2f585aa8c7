"""The commands that the templates make, and how complex they are."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import render

from annotations.access import world_view
from annotations.complexity import complexity as complexity_of
from annotations.filters import CommandFilters
from annotations.listing import Listing, Sort
from annotations.models import Duty, World
from annotations.models.problems import Subject

SORTS = {
    "position": Sort("No.", "position", is_number=True),
    "command": Sort("Command", "anonymized_text"),
    "category": Sort("Task category", "task_category"),
    "length": Sort("Tokens", "length", is_number=True),
}


@world_view(Duty.VIEW)
def commands(request: HttpRequest, world: World) -> HttpResponse:
    """Every command with its form."""
    rows = world.commands.select_related("logical_form")
    context = {
        "listing": Listing(request, CommandFilters, rows, SORTS),
        "problems": world.problems.filter(subject=Subject.COMMANDS),
    }
    return render(request, "annotations/commands.html", context)


@world_view(Duty.VIEW)
def complexity(request: HttpRequest, world: World) -> HttpResponse:
    """Counts, mean lengths and commands per form, by task category."""
    return render(request, "annotations/complexity.html", {"columns": complexity_of(world)})
