"""Pages of background jobs: progress, cancel, answer, result."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from django.contrib import messages
from django.core.exceptions import PermissionDenied
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache
from django_htmx.http import HttpResponseClientRefresh

from annotations.background.requesting import answer_job, cancel_job
from annotations.language.texts import Refusal
from annotations.models import Duty, Job, World
from annotations.people.access import READ, WRITE, WorldRequest, demand, plain_view, world_view
from annotations.web.worlds.report_presentation import shown_report

LISTED = 100


def job_view(methods: tuple[str, ...] = READ, does: str = "") -> Callable[..., Any]:
    """Make a view of one job, for those who may see it. A POST needs the duty that starting the job needed.

    The page stands in the frame of the job's world, where there is one. ``does`` is that of ``plain_view``.
    """

    def decorate(view: Callable[..., HttpResponse]) -> Callable[..., HttpResponse]:
        @wraps(view)
        def guarded(request: WorldRequest, pk: int) -> HttpResponse:
            jobs = Job.objects.visible_to(request.user).select_related("world", "created_by")
            job = get_object_or_404(jobs, pk=pk)
            world = job.world
            if world is not None and world.deletion_requested_at is None:
                request.world, request.duties = world, world.duties_of(request.user)
                demand(request, job.duty if request.method == "POST" else Duty.VIEW)
            elif not (request.user.is_superuser or job.created_by_id == request.user.pk):
                raise PermissionDenied("Only who asked for this may look at it.")
            return view(request, job)

        return plain_view(methods, does)(guarded)

    return decorate


@world_view(Duty.VIEW)
def jobs(request: WorldRequest, world: World) -> HttpResponse:
    """Show the jobs of a world, the newest first."""
    rows = world.jobs.select_related("created_by")[:LISTED]
    return render(request, "annotations/worlds/jobs.html", {"jobs": rows, "most": LISTED})


@job_view()
def job(request: WorldRequest, job: Job) -> HttpResponse:
    """Show one job: how far it is, or what came of it."""
    return render(request, "annotations/worlds/job.html", _state_of(request, job))


@never_cache
@job_view()
def job_state(request: WorldRequest, job: Job) -> HttpResponse:
    """Show what changes on the page of a job while it works; once it has ended the page is loaded anew, since its
    frame counts what the world holds."""
    if job.is_ended and request.htmx:
        return HttpResponseClientRefresh()
    return render(request, "annotations/worlds/_job_state.html", _state_of(request, job))


@job_view(WRITE, does="cancel a job")
def job_cancel(request: WorldRequest, job: Job) -> HttpResponse:
    """Stop a job within seconds, or drop an import that asks."""
    try:
        cancel_job(job)
    except Refusal as error:
        messages.warning(request, str(error))
    return redirect("job", pk=job.pk)


@job_view(WRITE, does="answer a job")
def job_answer(request: WorldRequest, job: Job) -> HttpResponse:
    """Import the kept files after all, as the report says."""
    try:
        arena = request.POST.get("arena", "")
        return redirect("job", pk=answer_job(job, request.user, arena).pk)
    except Refusal as error:
        messages.warning(request, str(error))
        return redirect("job", pk=job.pk)


def _state_of(request: WorldRequest, job: Job) -> dict[str, Any]:
    duties: frozenset[Duty] = getattr(request, "duties", frozenset())
    may_act = request.user.is_superuser or job.duty in duties or job.world is None
    shown = shown_report(job.kind, job.report, job.world) if job.report is not None else {}
    return {"job": job, "may_act": may_act, **shown}
