"""The error analysis of a run: its start and its end, how far it is, and the probes that it has asked."""

from __future__ import annotations

from django.contrib import messages
from django.db.models import OuterRef, Subquery
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.utils.http import url_has_allowed_host_and_scheme
from django.views.decorators.cache import never_cache

from annotations.background.requesting import cancel_job
from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.people.access import WRITE, PageRequest, WorldRequest, world_view
from annotations.showing.listing import Listing, Sort
from parser_service.models import TrainingRun
from parser_service.reviews.state import analysis_of
from parser_service.runs.analysis_requests import analysis_jobs, request_analysis
from parser_service.web.page_of_run import head_of
from parser_service.web.results.probe_filters import ProbeFilters

SORTS = {"position": Sort("Text", "position")}


@never_cache
@world_view(Duty.VIEW)
def analysis_state(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show the progress of the analysis, for a page that waits for it."""
    run = get_object_or_404(world.runs, pk=pk)
    context = {"run": run, "analysis": analysis_of(run), "is_update": True}
    return render(request, "parser_service/_analysis_state.html", context)


@world_view(Duty.REVIEW, WRITE, does="analyse errors")
def analysis_start(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Start an analysis of the run, unless one is queued or running. A complete one is repeated."""
    run = get_object_or_404(world.runs.select_related("world"), pk=pk)
    analysis = analysis_of(run)
    if analysis.is_possible:
        request_analysis(run, request.user, again=analysis.is_complete)
    else:
        messages.error(
            request, f"Run {run.pk} is {run.status}: only one that succeeded is analysed."
        )
    return _back(request, run)


@world_view(Duty.REVIEW, WRITE, does="cancel an error analysis")
def analysis_cancel(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Stop the analysis; what it has found stays."""
    run = get_object_or_404(world.runs.select_related("world"), pk=pk)
    job = analysis_jobs(run).active().first()
    try:
        if job:
            cancel_job(job)
    except Refusal as error:  # it has ended meanwhile
        messages.warning(request, error.message)
    return _back(request, run)


def _back(request: PageRequest, run: TrainingRun) -> HttpResponse:
    """Go back to the page that the form names as ``next``, or to the run."""
    address = request.POST.get("next", "")
    if url_has_allowed_host_and_scheme(address, {request.get_host()}, request.is_secure()):
        return redirect(address)
    return redirect("run", world=run.world.name, pk=run.pk)


@world_view(Duty.VIEW)
def probes(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """List the probes that were answered, each beside the answer to the utterance that it was made of."""
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    first = run.predictions.best().filter(example=OuterRef("base")).values("logical_form")[:1]
    rows = run.probes.filter(answer__isnull=False).select_related("base", "answer")
    context = {
        **head_of(run, "Probes"),
        "analysis": analysis_of(run),
        "listing": Listing(request, ProbeFilters, rows.annotate(before=Subquery(first)), SORTS),
    }
    return render(request, "parser_service/results/probes.html", context)
