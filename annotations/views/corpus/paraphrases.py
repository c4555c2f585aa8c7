"""How people say the commands."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, render

from annotations.lists.filters import ParaphraseFilters
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import Duty, World
from annotations.people.access import world_view
from annotations.rows.occurrences import MOST_SHOWN, examples_of_pair, logical_form_of

SORTS = {
    "position": Sort("No.", "position", is_number=True),
    "utterance": Sort("Paraphrase", "utterance"),
    "prompt": Sort("Prompt", "prompt"),
    "edit": Sort("Edits", "edit_distance", is_number=True),
    "jaccard": Sort("Jaccard", "jaccard_distance", is_number=True),
}


@world_view(Duty.VIEW)
def paraphrases(request: HttpRequest, world: World) -> HttpResponse:
    """List every paraphrase beside the prompt that it rewrites, with its distances."""
    listing = Listing(request, ParaphraseFilters, world.paraphrases.all(), SORTS)
    return render_list(request, "annotations/paraphrases.html", {"listing": listing})


@world_view(Duty.VIEW)
def paraphrase(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Show one paraphrase: its prompt, command and form, and the splits that hold it."""
    row = get_object_or_404(world.paraphrases.select_related("command"), pk=pk)
    context = {
        "row": row,
        "logical_form": logical_form_of(world.pk, row.logical_form),
        "examples": examples_of_pair(world.pk, row.utterance, row.logical_form)[:MOST_SHOWN],
    }
    return render(request, "annotations/paraphrase.html", context)
