"""Talk about a command as a robot would, beside the form that fills in."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.language.dialogue import Phase
from annotations.language.forms import to_corpus
from annotations.language.predicates import gloss
from annotations.models import Duty, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.people.access import READ_AND_WRITE, WRITE, world_view
from annotations.people.audit_log import note
from parser_service.conversing.keeping import keep
from parser_service.conversing.showing import asked_of, plan_of
from parser_service.conversing.talking import AnsweredMeanwhile, reply, start, state_of
from parser_service.models import Dialogue
from parser_service.serving.client import ParserAway, ParserRefused
from parser_service.serving.preparing import WorldLanguage

MOST_LISTED = 30
YES_OR_NO = (Phase.CHECKING, Phase.LEARNING, Phase.CONFIRMING)


@world_view(Duty.VIEW, READ_AND_WRITE)
def dialogues(request: HttpRequest, world: World) -> HttpResponse:
    """List the last dialogues; a POST starts one."""
    text = request.POST.get("utterance", "")
    context: dict[str, Any] = {"text": text, "most_text": MOST_CHARACTERS}
    if request.method == "POST":
        try:
            row = start(world, text, request.user)
            note(request, row.utterance)
            return redirect("dialogue", world=world.name, pk=row.pk)
        except (ParserAway, ParserRefused, ValueError) as error:
            context["trouble"] = str(error)
    rows = Dialogue.objects.filter(world=world).select_related("started_by")
    context |= {
        "rows": rows[:MOST_LISTED],
        "offered": world.offered_entities.filter(state="waiting").count(),
    }
    status = 422 if "trouble" in context else 200
    return render(request, "parser_service/dialogues.html", context, status=status)


@world_view(Duty.VIEW, READ_AND_WRITE)
def dialogue(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Show a dialogue and what it has come to; a POST answers."""
    row = get_object_or_404(Dialogue, world=world, pk=pk)
    trouble = ""
    if request.method == "POST":
        try:
            if request.POST.get("version") != str(row.version):
                raise AnsweredMeanwhile("Somebody has answered this meanwhile. Look at it again.")
            is_stop = "stop" in request.POST
            note(request, row.utterance)
            reply(row, "stop" if is_stop else request.POST.get("answer", ""))
            return redirect("dialogue", world=world.name, pk=pk)
        except (ParserAway, ParserRefused, AnsweredMeanwhile, ValueError) as error:
            trouble = str(error)
    context = {**_context_of(row), "trouble": trouble, "most_text": MOST_CHARACTERS}
    status = 422 if trouble else 200
    return render(request, "parser_service/dialogue.html", context, status=status)


@world_view(Duty.ANNOTATE, WRITE)
def dialogue_keep(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Make a labelled utterance of a dialogue that ended with a form."""
    row = get_object_or_404(Dialogue, world=world, pk=pk)
    try:
        utterance = keep(row, request.user)
    except ValueError as error:
        messages.error(request, str(error))
        return redirect("dialogue", world=world.name, pk=pk)
    messages.success(request, "Kept as a labelled utterance.")
    return redirect("utterance", world=world.name, pk=utterance.pk)


def _context_of(row: Dialogue) -> dict[str, Any]:
    state, language = state_of(row), WorldLanguage.of(row.world)
    has_form = state.phase is not Phase.REPHRASING and bool(row.state["parsed"] != "UNKNOWN")
    return {
        "row": row,
        "asked": asked_of(state),
        "is_yes_or_no": state.phase in YES_OR_NO,
        "grounded": to_corpus(state.form) if has_form else "",
        "english": gloss(state.form, language.predicates) if has_form else "",
        "plan": plan_of(state, language) if has_form else None,
        "offers": state.offers,
    }
