"""The logical forms of the commands, and the commands of each."""

from __future__ import annotations

from django.db.models import Count
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404

from annotations.lists.filters import CommandsOfLogicalFormFilters, LogicalFormFilters
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import Duty, LogicalForm, Paraphrase, World
from annotations.people.access import world_view
from annotations.rows.occurrences import MOST_SHOWN

SORTS = {
    "order": Sort("No.", "id", is_number=True),
    "form": Sort("Logical form", "text"),
    "category": Sort("Task category", "task_category"),
    "commands": Sort("Commands", "n_commands", is_number=True),
    "length": Sort("Tokens", "length", is_number=True),
    "depth": Sort("Depth", "depth", is_number=True),
}
COMMAND_SORTS = {
    "position": Sort("No.", "position", is_number=True),
    "command": Sort("Command", "anonymized_text"),
    "category": Sort("Task category", "task_category"),
    "length": Sort("Tokens", "length", is_number=True),
}


@world_view(Duty.VIEW)
def logical_forms(request: HttpRequest, world: World) -> HttpResponse:
    """List every logical form with the number of its commands."""
    rows = LogicalForm.objects.filter(world=world).annotate(n_commands=Count("commands"))
    context = {"listing": Listing(request, LogicalFormFilters, rows, SORTS)}
    return render_list(request, "annotations/logical_forms.html", context)


@world_view(Duty.VIEW)
def logical_form(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Show one logical form: its notations, its commands and how people say them."""
    row = get_object_or_404(LogicalForm, world=world, pk=pk)
    paraphrases = Paraphrase.objects.filter(world=world, logical_form=row.text)
    listing = Listing(
        request,
        CommandsOfLogicalFormFilters,
        row.commands.select_related("logical_form"),
        COMMAND_SORTS,
    )
    context = {"logical_form": row, "listing": listing, "paraphrases": paraphrases[:MOST_SHOWN]}
    return render_list(request, "annotations/logical_form.html", context)
