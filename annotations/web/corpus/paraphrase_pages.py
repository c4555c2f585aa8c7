"""How people say the commands."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.editing.edits import Overtaken
from annotations.labelling.entity_spans import anonymizer_of
from annotations.labelling.form_check import check_label
from annotations.labelling.giving import NotForThem, kinds_for
from annotations.labelling.label_decisions import correct_label
from annotations.language.texts import LanguageError
from annotations.models import Duty, WorkKind, World
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from annotations.rows.occurrences import MOST_SHOWN, examples_of_pair, logical_form_of
from annotations.showing.listing import Listing, Sort, render_list
from annotations.web.corpus.corpus_filters import ParaphraseFilters

SORTS = {
    "position": Sort("No.", "position", is_number=True),
    "utterance": Sort("Paraphrase", "utterance"),
    "prompt": Sort("Prompt", "prompt"),
    "edit": Sort("Edits", "edit_distance", is_number=True),
    "jaccard": Sort("Jaccard", "jaccard_distance", is_number=True),
}


@world_view(Duty.VIEW)
def paraphrases(request: WorldRequest, world: World) -> HttpResponse:
    """List every paraphrase beside the prompt that it rewrites, with its distances."""
    listing = Listing(request, ParaphraseFilters, world.paraphrases.all(), SORTS)
    return render_list(request, "annotations/corpus/paraphrases.html", {"listing": listing})


@world_view(Duty.VIEW)
def paraphrase(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one paraphrase: its prompt, command and form, and the splits that hold it."""
    row = get_object_or_404(world.paraphrases.select_related("command"), pk=pk)
    context = {
        "row": row,
        "may_correct": WorkKind.AUDIT in kinds_for(request.user, world),
        "logical_form": logical_form_of(world.pk, row.logical_form),
        "examples": examples_of_pair(world.pk, row.utterance, row.logical_form)[:MOST_SHOWN],
    }
    return render(request, "annotations/corpus/paraphrase.html", context)


@world_view(Duty.VIEW, WRITE, does="label a paraphrase")
def paraphrase_label(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Correct the label of a paraphrase; the queue knows who may."""
    row = get_object_or_404(world.paraphrases, pk=pk)
    sent = request.POST.get("version", "")
    version = int(sent) if sent.isascii() and sent.isdigit() and len(sent) < 10 else 0
    try:
        corrected = correct_label(row, request.POST.get("form", ""), request.user, version)
    except Overtaken as error:
        messages.error(request, f"{error.sentence} Look at it again.")
    except (LanguageError, NotForThem) as error:
        messages.error(request, str(error))
    else:
        is_same = corrected.version == row.version
        said = (
            "This is its label already."
            if is_same
            else "The label is corrected. Frozen splits keep the old one."
        )
        messages.success(request, said)
    return redirect("paraphrase", world=world.name, pk=pk)


@world_view(Duty.VIEW, WRITE, does=NOTHING)
def paraphrase_check(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Say what is wrong with a label while somebody writes it."""
    row = get_object_or_404(world.paraphrases, pk=pk)
    anonymized = anonymizer_of(world).anonymize(row.utterance).command
    form = request.POST.get("form", "")
    return JsonResponse(check_label(world, anonymized, form, may_be_unknown=True))
