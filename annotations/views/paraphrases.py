"""How people say it."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import render

from annotations.access import world_view
from annotations.filters import ParaphraseFilters
from annotations.listing import Listing, Sort
from annotations.models import Duty, World

SORTS = {
    "position": Sort("No.", "position", is_number=True),
    "utterance": Sort("Paraphrase", "utterance"),
    "prompt": Sort("Prompt", "prompt"),
    "edit": Sort("Edits", "edit_distance", is_number=True),
    "jaccard": Sort("Jaccard", "jaccard_distance", is_number=True),
}


@world_view(Duty.VIEW)
def paraphrases(request: HttpRequest, world: World) -> HttpResponse:
    """Every paraphrase beside the prompt that it rewrites, with its distances."""
    listing = Listing(request, ParaphraseFilters, world.paraphrases.all(), SORTS)
    return render(request, "annotations/paraphrases.html", {"listing": listing})
