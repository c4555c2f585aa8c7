"""Entities that people named in dialogues: annotators put them into the ontology, or keep them out."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.models import Duty, World
from annotations.people.access import WRITE, world_view
from parser_service.conversing.offering import confirm, refuse
from parser_service.models import OfferedEntity, OfferState

MOST_DECIDED = 20


@world_view(Duty.VIEW)
def offered_entities(request: HttpRequest, world: World) -> HttpResponse:
    """Show what waits for an annotator, and what was decided last."""
    rows = OfferedEntity.objects.filter(world=world).select_related("decided_by")
    decided = rows.exclude(state=OfferState.WAITING).order_by("-decided_at")
    context = {
        "waiting": rows.filter(state=OfferState.WAITING).order_by("pk"),
        "decided": decided[:MOST_DECIDED],
    }
    return render(request, "parser_service/offered_entities.html", context)


@world_view(Duty.ANNOTATE, WRITE)
def offered_entity_decide(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Confirm an offered entity, or refuse it."""
    row = get_object_or_404(OfferedEntity, world=world, pk=pk)
    try:
        if "confirm" in request.POST:
            entity = confirm(row, request.user)
            messages.success(request, f"The ontology has {entity.text} ({row}).")
        else:
            refuse(row, request.user)
            messages.success(request, f"{row} stays out of the ontology.")
    except ValueError as error:
        messages.error(request, str(error))
    return redirect("offered_entities", world=world.name)
