"""The meanings there are, and the commands of each."""

from __future__ import annotations

from django.db.models import Count
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.access import world_view
from annotations.filters import CommandsOfFormFilters, FormFilters
from annotations.listing import Listing, Sort
from annotations.models import Duty, LogicalForm, Paraphrase, World

SORTS = {
    "order": Sort("No.", "id", is_number=True),
    "form": Sort("Form", "text"),
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
def forms(request: HttpRequest, world: World) -> HttpResponse:
    """Every logical form with the number of its commands."""
    rows = LogicalForm.objects.filter(world=world).annotate(n_commands=Count("commands"))
    context = {"listing": Listing(request, FormFilters, rows, SORTS)}
    return render(request, "annotations/forms.html", context)


@world_view(Duty.VIEW)
def form(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """One logical form: its notations, its commands and how people say them."""
    logical_form = get_object_or_404(LogicalForm, world=world, pk=pk)
    rows = logical_form.commands.select_related("logical_form")
    context = {
        "logical_form": logical_form,
        "listing": Listing(request, CommandsOfFormFilters, rows, COMMAND_SORTS),
        "paraphrases": Paraphrase.objects.filter(world=world, logical_form=logical_form.text)[:20],
    }
    return render(request, "annotations/form.html", context)
