"""The commands that the templates make, and how complex they are."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.generation.complexity import complexity as complexity_of
from annotations.lists.filters import CommandFilters
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import Duty, World
from annotations.models.description import Subject
from annotations.people.access import world_view
from annotations.rows.occurrences import MOST_SHOWN

SORTS = {
    "position": Sort("No.", "position", is_number=True),
    "command": Sort("Command", "anonymized_text"),
    "category": Sort("Task category", "task_category"),
    "length": Sort("Tokens", "length", is_number=True),
}


@world_view(Duty.VIEW)
def commands(request: HttpRequest, world: World) -> HttpResponse:
    """List every command with its form."""
    rows = world.commands.select_related("logical_form")
    context = {
        "listing": Listing(request, CommandFilters, rows, SORTS),
        "problems": world.problems.filter(subject=Subject.COMMANDS),
    }
    return render_list(request, "annotations/commands.html", context)


@world_view(Duty.VIEW)
def command(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Show one command: its form, the template that makes it, and how people say it."""
    rows = world.commands.select_related("logical_form", "template")
    row = get_object_or_404(rows, pk=pk)
    context = {"row": row, "paraphrases": row.paraphrases.all()[:MOST_SHOWN]}
    return render(request, "annotations/command.html", context)


@world_view(Duty.VIEW)
def complexity(request: HttpRequest, world: World) -> HttpResponse:
    """Show counts, mean lengths and commands per form, by task category."""
    return render(request, "annotations/complexity.html", {"columns": complexity_of(world)})
