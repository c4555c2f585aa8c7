"""The pages that look at both apps: the list of worlds, the home of one, banner and health."""

from __future__ import annotations

from django.contrib.auth.decorators import login_not_required
from django.db import connection
from django.http import HttpRequest, HttpResponse, JsonResponse
from django.shortcuts import render
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_safe

from annotations.access import world_view
from annotations.models import Duty, World
from gpsr_site.counts import counts_of, counts_of_all
from gpsr_site.flow import next_steps, stages


@require_safe
def home(request: HttpRequest) -> HttpResponse:
    """The worlds that one may see."""
    worlds = World.objects.visible_to(request.user)
    counts = counts_of_all(worlds)
    listed = [(world, counts[world.pk]) for world in worlds]
    return render(request, "gpsr_site/home.html", {"listed": listed})


@world_view(Duty.VIEW)
def world(request: HttpRequest, world: World) -> HttpResponse:
    """The flow of one world with its counts, and what to do next."""
    counts = counts_of(world)
    context = {
        "stages": stages(counts),
        "steps": next_steps(counts, request.duties),
        "recent_runs": world.runs.for_table()[:6],
    }
    return render(request, "gpsr_site/world.html", context)


@never_cache
@require_safe
def banner(request: HttpRequest) -> HttpResponse:
    """The worker's state, which every page asks for every two seconds."""
    return render(request, "gpsr_site/_banner.html")


@never_cache
@login_not_required
@require_safe
def healthz(request: HttpRequest) -> HttpResponse:
    """200 where the database answers: for whoever supervises the process."""
    with connection.cursor() as cursor:
        cursor.execute("SELECT 1")
    return JsonResponse({"status": "ok"})
