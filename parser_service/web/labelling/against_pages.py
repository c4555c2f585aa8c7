"""Runs on people's paraphrases against runs on models': a part of the page with the figures of paraphrases."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.language.texts import LanguageError, Refusal, say_count
from annotations.models import Duty, World
from annotations.people.access import WRITE, WorldRequest, world_view
from annotations.people.allowances import may_take_long
from annotations.people.audit_log import note
from annotations.web.forms import sentence_of
from parser_service.labelling.people_against_models import (
    has_both,
    run_pairs,
    start_people_against_models,
)
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.pretrained_files import find_gaps
from parser_service.parsers.registry import make_config, parsers, title_of
from parser_service.runs.recommended import advise, usual_split


@never_cache
@world_view(Duty.VIEW)
def paraphrase_runs(request: WorldRequest, world: World) -> HttpResponse:
    """Show the runs on each, and the button that starts them."""
    pairs = run_pairs(world)
    trainable = trainable_parsers()
    recommended = advise(world, usual_split(world)).recommendation.parser
    context = {
        "pairs": pairs,
        "first_runs": [pair.people for pair in pairs],
        "is_active": any(pair.is_active for pair in pairs),
        "can_start": has_both(world),
        "parsers": [(name, title_of(name)) for name in trainable],
        "chosen": recommended if recommended in trainable else "linear",
    }
    return render(request, "parser_service/labelling/_people_against_models.html", context)


def trainable_parsers() -> list[str]:
    """Return the parsers that learn from pairs alone and lack nothing here."""
    return [
        name
        for name, entry in parsers().items()
        if entry.learns
        and Protocol.STRICT in entry.protocols
        and not find_gaps(make_config(name), anywhere=False)
    ]


@may_take_long
@world_view(Duty.MANAGE, WRITE, does="train on people and on models")
def paraphrase_runs_start(request: WorldRequest, world: World) -> HttpResponse:
    """Start a run on people's paraphrases and one on models'."""
    try:
        answers = start_people_against_models(world, request.POST.get("parser", ""), request.user)
    except Refusal as refusal:
        messages.error(request, refusal.message)
    except LanguageError as error:
        messages.error(request, sentence_of(error))
    else:
        new = sum(is_new for _, is_new in answers)
        note(request, answers[0][0].split.name)
        started = f"Started {say_count(new, 'run')} on {answers[0][0].split.name}."
        messages.success(request, started if new else "Both runs have been asked for already.")
    figures = reverse("paraphrase_figures", kwargs={"world": world.name})
    return redirect(f"{figures}#against-title")
