"""Try it, beside the lines that people write: what the robot would answer once they are stored."""

from __future__ import annotations

import json

from django.http import HttpResponse
from django.shortcuts import render

from annotations.language.induction import MOST_CHARACTERS
from annotations.language.texts import LanguageError
from annotations.models import Duty, World
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from annotations.web.description.example_forms import ExamplesForm
from annotations.web.forms import sentence_of
from parser_service.serving.proposed_world import answerer_with

MOST_TRIED = 10  # that are answered again with each change of the lines


@world_view(Duty.ANNOTATE, WRITE, does=NOTHING)
def try_examples(request: WorldRequest, world: World) -> HttpResponse:
    """Answer each text in ``said``, the newest first, by the world together with what ``lines`` propose."""
    form = ExamplesForm(world, request.POST)
    given = (" ".join(each.split())[:MOST_CHARACTERS] for each in request.POST.getlist("said"))
    said = list(dict.fromkeys(filter(None, given)))[:MOST_TRIED]
    context: dict[str, object] = {}
    text = form.cleaned_data["lines"] if form.is_valid() else ""
    try:
        answerer = answerer_with(world, text) if said else None
    except LanguageError as error:
        context["refused"] = sentence_of(error)
    else:
        answers = map(json.loads, answerer.parse(said, beam=1)) if answerer else ()
        nothing = ({"utterance": each, "is_unknown": True} for each in said)
        context["tried"] = list(answers if answerer else nothing)
    return render(request, "parser_service/serving/_tried.html", context)
