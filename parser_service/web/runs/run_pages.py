"""Training runs: every member may watch, admins cancel."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.models.background import Status
from annotations.people.access import WRITE, WorldRequest, world_view
from annotations.showing.listing import Listing, Sort
from parser_service.models import TrainingRun
from parser_service.parsers.registry import parsers, title_of
from parser_service.results.learning_curves import curves_url
from parser_service.results.run_figures import KNOWN_FORMS, order_of, scores_by_form
from parser_service.results.table_parts import marked
from parser_service.reviews.earlier import history_of_errors
from parser_service.reviews.state import analysis_of
from parser_service.runs import lifecycle
from parser_service.runs.curves import CURVES, loss_curves, will_have_curves
from parser_service.runs.promoting import is_learned, learned_part
from parser_service.runs.retraining import retrained
from parser_service.runs.waiting import waiting_of
from parser_service.web.runs.run_filters import RunFilters

SORTS = {
    "newest": Sort("Run", "-id", is_number=True),
    "parser": Sort("Parser", "parser"),
    "status": Sort("Status", "status"),
    "seconds": Sort("Training time", "seconds_trained", is_number=True),
}


@world_view(Duty.VIEW)
def runs(request: WorldRequest, world: World) -> HttpResponse:
    """List all runs, newest first."""
    return render(request, "parser_service/runs/runs.html", {"listing": runs_of(request, world)})


@never_cache
@world_view(Duty.VIEW)
def runs_table(request: WorldRequest, world: World) -> HttpResponse:
    """Show the table alone; the page refreshes itself with it."""
    return render(
        request, "parser_service/runs/_runs_table.html", {"listing": runs_of(request, world)}
    )


def runs_of(request: WorldRequest, world: World) -> Listing:
    return Listing(request, RunFilters, world.runs.for_table(), SORTS)


@world_view(Duty.VIEW)
def run(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one run: progress, curves, log and results."""
    context = state_of(world, pk)
    context["newest"], context["again"] = retrained(context["run"])
    shown = context["run"]
    context["is_promoted"] = is_promoted = learned_part(world) == shown
    context["may_be_promoted"] = (
        shown.status == Status.SUCCEEDED and is_learned(shown) and not is_promoted
    )
    return render(request, "parser_service/runs/run.html", context)


@never_cache
@world_view(Duty.VIEW)
def run_state(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show the part of a run's page that changes while it runs."""
    context = {**state_of(world, pk), "is_update": True}
    return render(request, "parser_service/runs/_run_state.html", context)


@never_cache
@world_view(Duty.VIEW)
def run_charts(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show the curves, for a page that was opened before there were any."""
    return render(request, "parser_service/runs/_run_charts.html", state_of(world, pk))


def state_of(world: World, pk: int) -> dict[str, Any]:
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    entry = parsers().get(run.parser)
    return {
        "run": run,
        "aside": marked(title_of(run.parser), run.parser),
        "curves_url": curves_url(world, run),
        "loss_title": f"Loss by epoch, {entry.loss_unit if entry else 'nats'}",
        "evaluations": sorted(run.evaluations.all(), key=order_of),
        "by_form": scores_by_form(run),
        "known_forms": KNOWN_FORMS,
        "history": history_of_errors(run) if run.is_ended else None,
        "epochs": list(run.epochs.all()),
        "will_have_curves": will_have_curves(run),
        "waiting": waiting_of(run) if run.status == Status.QUEUED else None,
        "events": list(run.events.order_by("-id")[:200])[::-1],
        "checkpoints": run.checkpoints.all(),
        "analysis": analysis_of(run) if run.is_ended else None,
    }


@never_cache
@world_view(Duty.VIEW)
def run_curves(request: WorldRequest, world: World, pk: int) -> JsonResponse:
    """Return loss or accuracy by epoch as the charts read them."""
    run = get_object_or_404(TrainingRun, world=world, pk=pk)
    draw = CURVES.get(request.GET.get("show", ""), loss_curves)
    return JsonResponse({**draw(list(run.epochs.all())), "done": run.is_ended})


@world_view(Duty.MANAGE, WRITE, does="cancel a run")
def run_cancel(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Cancel a run."""
    run = get_object_or_404(TrainingRun, world=world, pk=pk)
    try:
        lifecycle.cancel(run)
    except Refusal as error:
        messages.warning(request, error.message)
    return redirect("run", world=world.name, pk=pk)
