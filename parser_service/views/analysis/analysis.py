"""The error analysis of a run: how far it is, its start and its end. Other pages show the same part."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.utils.http import url_has_allowed_host_and_scheme
from django.views.decorators.cache import never_cache

from annotations.jobs import cancel_job
from annotations.models import Duty, World
from annotations.people.access import WRITE, world_view
from parser_service.analysing.state import analysis_of
from parser_service.models import TrainingRun
from parser_service.runs.analysis_requests import analysis_jobs, request_analysis


@never_cache
@world_view(Duty.VIEW)
def analysis_state(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Show how far the analysis is, for a page that waits for it."""
    run = get_object_or_404(world.runs, pk=pk)
    context = {"run": run, "analysis": analysis_of(run), "is_update": True}
    return render(request, "parser_service/_analysis_state.html", context)


@world_view(Duty.REVIEW, WRITE)
def analysis_start(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Let a worker analyse the run, again where that was done; one that waits or works already goes on."""
    run = get_object_or_404(world.runs.select_related("world"), pk=pk)
    analysis = analysis_of(run)
    if analysis.is_possible:
        request_analysis(run, request.user, again=analysis.is_complete)
    else:
        messages.error(
            request, f"Run {run.pk} is {run.status}: only one that succeeded is analysed."
        )
    return _back(request, run)


@world_view(Duty.REVIEW, WRITE)
def analysis_cancel(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Stop the analysis; what it has found stays."""
    run = get_object_or_404(world.runs.select_related("world"), pk=pk)
    job = analysis_jobs(run).active().first()
    try:
        if job:
            cancel_job(job)
    except ValueError as error:  # it has ended meanwhile
        messages.warning(request, str(error))
    return _back(request, run)


def _back(request: HttpRequest, run: TrainingRun) -> HttpResponse:
    """Go to the page that was asked from, or to the run."""
    address = request.POST.get("next", "")
    if url_has_allowed_host_and_scheme(address, {request.get_host()}, request.is_secure()):
        return redirect(address)
    return redirect("run", world=run.world.name, pk=run.pk)
