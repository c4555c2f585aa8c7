"""Which run is the learned part of what answers: the evidence for it, what may take its place, and the history."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.people.access import WRITE, WorldRequest, world_view
from annotations.people.audit_log import note
from annotations.showing.paging import number_in
from annotations.web.editing.undo import say_with_undo
from parser_service.analysis.sureness import LEAST_PEOPLE
from parser_service.models import AnsweringOrder, Promotion, TrainingRun
from parser_service.models.answering import MOST_ALLOWED_WRONG, answering_of
from parser_service.parsers.registry import untrained
from parser_service.parsers.server_address import server
from parser_service.runs.analysis_requests import request_measurement_with
from parser_service.runs.promoting import (
    MOST_REASON,
    decline,
    is_learned,
    learned_part,
    previous_run,
    promote,
    roll_back,
)
from parser_service.runs.score_evidence import compare_scores, judged_by
from parser_service.serving.answering import (
    answering_parts,
    calibrated_parts,
    choose_answering,
    version_of,
    why_no_last_part,
)
from parser_service.serving.parser_client import ParserAway, ParserRefused, client

MOST_LISTED = 100  # runs that may be promoted, and decisions of the history


@world_view(Duty.VIEW)
def promotions(request: WorldRequest, world: World) -> HttpResponse:
    """Show the promoted run, proposals, the runs that may take its place, and what was decided before."""
    present = (
        world.promotions.promoted()
        .select_related("run__split", "decided_by")
        .prefetch_related("run__evaluations")
        .first()
    )
    run = present.run if present else None
    chosen = (
        world.runs.succeeded().for_table().filter(pk=number_in(request.GET.get("run", ""))).first()
    )
    proposals = (
        world.promotions.proposed()
        .select_related("run__split")
        .prefetch_related("run__evaluations")
    )
    candidates = _candidates(world, run)
    shown = [run, chosen, *(each.run for each in proposals), *candidates]
    context = {
        "shown": [each for each in shown if each],
        "present": present,
        "present_scores": compare_scores(run, None) if run else [],
        "previous": previous_run(world),
        "present_learns": bool(run and is_learned(run)),
        "chosen": chosen if chosen != run else None,
        "chosen_learns": bool(chosen and is_learned(chosen)),
        "chosen_scores": compare_scores(chosen, run) if chosen else [],
        "proposals": [(each, compare_scores(each.run, run)) for each in proposals],
        "candidates": candidates,
        "history": world.promotions.exclude(decided_at=None)
        .select_related("run", "decided_by")
        .order_by("-decided_at", "-pk")[:MOST_LISTED],
        "most_reason": MOST_REASON,
        **_what_answers(world),
    }
    return render(request, "parser_service/serving/promotions.html", context)


@world_view(Duty.MANAGE, WRITE, does="promote a run")
def promotion_promote(request: WorldRequest, world: World) -> HttpResponse:
    """Promote a run."""
    run = get_object_or_404(
        TrainingRun.objects.select_related("world"),
        world=world,
        pk=number_in(request.POST.get("run", "")),
    )
    reason = request.POST.get("reason", "")
    note(request, f"run {run.pk}")

    def decide() -> Promotion:
        row = promote(run, request.user, reason)
        request_measurement_with(run, request.user)
        return row

    return _decide(request, world, decide)


@world_view(Duty.MANAGE, WRITE, does="roll back to the run before")
def promotion_roll_back(request: WorldRequest, world: World) -> HttpResponse:
    """Roll back to the run that was promoted before the present one."""
    reason, before = request.POST.get("reason", ""), previous_run(world)
    note(request, f"run {before.pk}" if before else "")
    return _decide(request, world, lambda: roll_back(world, request.user, reason))


@world_view(Duty.MANAGE, WRITE, does="decline a proposed run")
def promotion_decline(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Decline a proposal; the present run goes on answering."""
    proposal = get_object_or_404(Promotion, world=world, pk=pk)
    return _decide(request, world, lambda: decline(world, proposal.pk, request.user))


@world_view(Duty.MANAGE, WRITE, does="choose what answers")
def answering(request: WorldRequest, world: World) -> HttpResponse:
    """Choose which parts answer, and the share of wrong acts that is allowed; the message offers to undo it."""
    sent, before = request.POST, answering_of(world)
    try:
        allowed = float(sent.get("allowed_percent", "")) / 100
    except ValueError:
        messages.error(request, "Wrong acts that are allowed are a number of percent, such as 2.")
        return redirect("promotions", world=world.name)

    def choose() -> None:
        version = number_in(sent.get("version", ""))
        asks = bool(sent.get("asks_language_model"))
        row = choose_answering(world, sent.get("order", ""), allowed, request.user, version, asks)
        values = {
            "order": before.order,
            "allowed_percent": 100 * before.allowed_wrong,
            "asks_language_model": "on" * before.asks_language_model,
            "version": row.version,
        }
        address = reverse("answering", kwargs={"world": world.name})
        say_with_undo(request, "Saved. It answers so from now on.", address, **values)

    return _decide(request, world, choose)


@never_cache
@world_view(Duty.VIEW)
def parser_state(request: WorldRequest, world: World) -> HttpResponse:
    """Say which run the parse server has as the learned part: a part of other pages, which ask for it by themselves."""
    context: dict[str, Any] = {"promoted": learned_part(world), "parts": answering_parts(world)}
    try:
        held = {each["world"]: each for each in client().parsers()}
        context["held"] = held.get(world.name, {})
    except (ParserAway, ParserRefused) as error:
        context["away"] = error.message
    return render(request, "parser_service/serving/_parser_state.html", context)


def _decide(request: WorldRequest, world: World, verb: Callable[[], object]) -> HttpResponse:
    try:
        verb()
    except Refusal as error:
        messages.error(request, error.message)
    return redirect("promotions", world=world.name)


def _what_answers(world: World) -> dict[str, Any]:
    """Return which parts answer, what was chosen about them, and how sure an answer has to be."""
    row, parts = answering_of(world), answering_parts(world)
    return {
        "answering": row,
        "answering_version": version_of(row),
        "allowed_percent": 100 * row.allowed_wrong,
        "most_percent": round(100 * MOST_ALLOWED_WRONG),
        "orders": AnsweringOrder.choices,
        "parts": parts,
        "calibrated": calibrated_parts(world, row, parts),
        "last_problem": why_no_last_part(world),
        "model_server": server(),
        "least_people": LEAST_PEOPLE,
    }


def _candidates(world: World, present: TrainingRun | None) -> list[TrainingRun]:
    """Return the runs that may be promoted, those that are most often right first, on what people say where
    they were asked enough of it."""
    runs = world.runs.succeeded().on_all_pairs().for_table().exclude(parser__in=untrained())
    if present:
        runs = runs.exclude(pk=present.pk)
    listed = list(runs.order_by("-pk")[:MOST_LISTED])

    def accuracy(run: TrainingRun) -> float:
        scores = judged_by(run)
        return scores[0].accuracy if scores else -1.0

    return sorted(listed, key=accuracy, reverse=True)
