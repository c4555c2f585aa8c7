"""The commands that the templates make, how complex they are, and their logical forms."""

from __future__ import annotations

from django.http import HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.generation.complexity import kept_complexity
from annotations.models import Command, Duty, LogicalForm, Paraphrase, World
from annotations.models.counting import count_of
from annotations.models.description import ProblemSubject
from annotations.people.access import WorldRequest, world_view
from annotations.rows.occurrences import MOST_SHOWN
from annotations.showing.listing import Listing, Sort, render_list
from annotations.web.corpus.corpus_filters import (
    CommandFilters,
    CommandsOfLogicalFormFilters,
    LogicalFormFilters,
)

SORTS = {
    "position": Sort("No.", "position", is_number=True),
    "command": Sort("Command", "anonymized_text"),
    "category": Sort("Task category", "task_category"),
    "length": Sort("Tokens", "length", is_number=True),
}
FORM_SORTS = {
    "order": Sort("No.", "id", is_number=True),
    "form": Sort("Logical form", "text"),
    "category": Sort("Task category", "task_category"),
    "commands": Sort("Commands", "n_commands", is_number=True),
    "length": Sort("Tokens", "length", is_number=True),
    "depth": Sort("Depth", "depth", is_number=True),
}


@world_view(Duty.VIEW)
def commands(request: WorldRequest, world: World) -> HttpResponse:
    """List every command with its form."""
    rows = world.commands.select_related("logical_form")
    context = {
        "listing": Listing(request, CommandFilters, rows, SORTS),
        "problems": world.problems.filter(subject=ProblemSubject.COMMANDS),
    }
    return render_list(request, "annotations/corpus/commands.html", context)


@world_view(Duty.VIEW)
def command(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one command: its form, the template that makes it, and how people say it."""
    rows = world.commands.select_related("logical_form", "template")
    row = get_object_or_404(rows, pk=pk)
    context = {"row": row, "paraphrases": row.paraphrases.all()[:MOST_SHOWN]}
    return render(request, "annotations/corpus/command.html", context)


@world_view(Duty.VIEW)
def complexity(request: WorldRequest, world: World) -> HttpResponse:
    """Show counts, mean lengths and commands per form, by task category."""
    return render(
        request, "annotations/corpus/complexity.html", {"columns": kept_complexity(world)}
    )


@world_view(Duty.VIEW)
def logical_forms(request: WorldRequest, world: World) -> HttpResponse:
    """List every logical form with the number of its commands."""
    rows = LogicalForm.objects.filter(world=world).annotate(
        n_commands=count_of(Command.objects.all(), "logical_form")
    )
    context = {"listing": Listing(request, LogicalFormFilters, rows, FORM_SORTS)}
    return render_list(request, "annotations/corpus/logical_forms.html", context)


@world_view(Duty.VIEW)
def logical_form(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one logical form: its notations, its commands and how people say them."""
    row = get_object_or_404(LogicalForm, world=world, pk=pk)
    paraphrases = Paraphrase.objects.filter(world=world, logical_form=row.text)
    listing = Listing(
        request,
        CommandsOfLogicalFormFilters,
        row.commands.select_related("logical_form"),
        SORTS,
    )
    context = {"logical_form": row, "listing": listing, "paraphrases": paraphrases[:MOST_SHOWN]}
    return render_list(request, "annotations/corpus/logical_form.html", context)
