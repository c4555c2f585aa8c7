"""Dialogues: talk about a command as a robot would, and decide about the entities that people named."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.language.forms import to_corpus
from annotations.language.plans import Phase, spoken
from annotations.language.texts import Refusal
from annotations.language.world import gloss
from annotations.models import Duty, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.people.audit_log import note
from annotations.showing.listing import count_some
from parser_service.models import Dialogue, OfferedEntity, OfferState
from parser_service.serving.conversation import AnsweredMeanwhile, keep, reply, start, state_of
from parser_service.serving.dialogue_json import asked_of, plan_of, task_plan_in
from parser_service.serving.entity_offers import confirm, refuse
from parser_service.serving.preparing import WorldLanguage

MOST_LISTED = 30
YES_OR_NO = (Phase.CHECKING, Phase.LEARNING, Phase.CONFIRMING)

MOST_WAITING, MOST_DECIDED = 200, 20


@world_view(Duty.VIEW, READ_AND_WRITE, does="begin a dialogue")
def dialogues(request: WorldRequest, world: World) -> HttpResponse:
    """List the last dialogues; a POST starts one."""
    text = request.POST.get("utterance", "")
    context: dict[str, Any] = {"text": text, "most_text": MOST_CHARACTERS}
    if request.method == "POST":
        try:
            row = start(world, text, request.user)
            note(request, row.utterance)
            return redirect("dialogue", world=world.name, pk=row.pk)
        except Refusal as error:
            context["trouble"] = error.message
    rows = Dialogue.objects.filter(world=world).select_related("started_by")
    context |= {
        "rows": rows[:MOST_LISTED],
        "offered": count_some(world.offered_entities.filter(state=OfferState.WAITING)),
    }
    status = 422 if "trouble" in context else 200
    return render(request, "parser_service/serving/dialogues.html", context, status=status)


@world_view(Duty.VIEW, READ_AND_WRITE, does="answer in a dialogue")
def dialogue(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show a dialogue and the form so far. A POST answers."""
    row = get_object_or_404(Dialogue, world=world, pk=pk)
    trouble = ""
    if request.method == "POST":
        try:
            if request.POST.get("version") != str(row.version):
                raise AnsweredMeanwhile
            is_stop = "stop" in request.POST
            note(request, row.utterance)
            reply(row, "stop" if is_stop else request.POST.get("answer", ""))
            return redirect("dialogue", world=world.name, pk=pk)
        except Refusal as error:
            trouble = error.message
    state, language = state_of(row), WorldLanguage.of(row.world)
    has_form = state.phase is not Phase.REPHRASING and bool(row.state["parsed"] != "UNKNOWN")
    task_plan = task_plan_in(row, language) if has_form else None
    context = {
        "row": row,
        "task_plan": task_plan and task_plan.as_json(),
        "spoken": spoken(task_plan) if task_plan else "",
        "asked": asked_of(state),
        "is_yes_or_no": state.phase in YES_OR_NO,
        "grounded": to_corpus(state.form) if has_form else "",
        "english": gloss(
            state.form,
            language.predicates,
            language.ontology.classes,
            language.ontology.class_of_text,
        )
        if has_form
        else "",
        "plan": plan_of(row, language).as_json() if has_form else None,
        "offers": state.offers,
        "trouble": trouble,
        "most_text": MOST_CHARACTERS,
    }
    status = 422 if trouble else 200
    return render(request, "parser_service/serving/dialogue.html", context, status=status)


@world_view(Duty.ANNOTATE, WRITE, does="keep a dialogue as an utterance")
def dialogue_keep(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Make a labelled utterance of a dialogue that ended with a form."""
    row = get_object_or_404(Dialogue, world=world, pk=pk)
    try:
        utterance = keep(row, request.user)
    except Refusal as error:
        messages.error(request, error.message)
        return redirect("dialogue", world=world.name, pk=pk)
    messages.success(request, "Kept as a labelled utterance.")
    return redirect("utterance", world=world.name, pk=utterance.pk)


@world_view(Duty.VIEW)
def offered_entities(request: WorldRequest, world: World) -> HttpResponse:
    """Show what waits for an annotator, and what was decided last."""
    rows = OfferedEntity.objects.filter(world=world).select_related("decided_by")
    decided = rows.exclude(state=OfferState.WAITING).filter(decided_at__isnull=False)
    context = {
        "waiting": rows.filter(state=OfferState.WAITING).order_by("pk")[:MOST_WAITING],
        "decided": decided.order_by("-decided_at")[:MOST_DECIDED],
    }
    return render(request, "parser_service/serving/offered_entities.html", context)


@world_view(Duty.ANNOTATE, WRITE, does="decide about a word from dialogues")
def offered_entity_decide(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Confirm an offered entity, or refuse it."""
    row = get_object_or_404(OfferedEntity, world=world, pk=pk)
    try:
        if "confirm" in request.POST:
            entity = confirm(row, request.user)
            messages.success(request, f"The ontology has {entity.text} ({row}).")
        else:
            refuse(row, request.user)
            messages.success(request, f"{row} stays out of the ontology.")
    except Refusal as error:
        messages.error(request, error.message)
    return redirect("offered_entities", world=world.name)
