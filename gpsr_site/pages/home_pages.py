"""The pages that look at both apps: the list of worlds, the overview of one, banner and health."""

from __future__ import annotations

from django.contrib.auth.decorators import login_not_required
from django.db import connection
from django.http import HttpRequest, HttpResponse, JsonResponse
from django.shortcuts import redirect, render
from django.templatetags.static import static
from django.views.decorators.cache import never_cache

from annotations.models import Duty, TaskCategory, World
from annotations.people.access import (
    NOTHING,
    WRITE,
    PageRequest,
    WorldRequest,
    plain_view,
    world_view,
)
from gpsr_site.overview.best_runs import best_runs
from gpsr_site.overview.counts import Counts, counts_of, counts_of_all
from gpsr_site.overview.first_steps import GUIDES, beginning_of, first_steps
from gpsr_site.overview.flow import stages
from gpsr_site.overview.work_list import WorkList
from gpsr_site.overview.workers import workers_now
from parser_service.results.answerer_rows import newest_answerer_table
from parser_service.results.worth_of_paraphrases import measured_elsewhere, measured_here
from parser_service.serving.answering import answering_parts

MOST_SHOWN = 3  # things that wait, for each world of the list
MOST_JOBS = 5  # in the work list; the page of jobs has them all


class OverviewRequest(WorldRequest):
    """For signatures: what the page has counted, for the rail."""

    counts: Counts


@plain_view()
def home(request: PageRequest) -> HttpResponse:
    """Show the worlds that the reader may see, with what waits in each."""
    worlds = World.objects.visible_to(request.user)
    counts = counts_of_all(worlds)
    duties = worlds.duties_by_world(request.user)
    workers = workers_now()
    listed = []
    for world in worlds:
        work = WorkList(world, counts[world.pk], duties[world.pk], workers)
        listed.append((world, counts[world.pk], work.items[:MOST_SHOWN]))
    return render(request, "gpsr_site/home.html", {"listed": listed})


@world_view(Duty.VIEW)
def world(request: OverviewRequest, world: World) -> HttpResponse:
    """Show what there is in a world, what waits, and how well its parsers do."""
    counts = request.counts = counts_of(world)  # the rail takes them from there
    best = best_runs(world)
    jobs = world.jobs.needing_attention()[:MOST_JOBS]
    others = World.objects.present().exclude(pk=world.pk)
    is_only_world = request.user.is_superuser and not others.exists()
    work = WorkList(world, counts, request.duties, workers_now(), best, jobs, is_only_world)
    # They close by themselves once a parser has been scored.
    steps_closed = request.session.get(_steps_key(world), bool(counts.evaluated))
    context: dict[str, object] = {}
    if not steps_closed:
        beginning = beginning_of(world)
        steps = first_steps(world, beginning, counts, request.duties)
        context = {"first_steps": steps, "guide_page": GUIDES[beginning]}
    if counts.evaluated and counts.paraphrases:
        context["worth"] = measured_here(world)
    elif counts.commands and not counts.paraphrases:
        context["worth"] = measured_elsewhere()
    context |= {
        "stages": stages(counts),
        "work_groups": work.groups,
        "steps_closed": steps_closed,
        "coverage": TaskCategory.objects.filter(grammar__world=world),
        "measured": newest_answerer_table(world) if counts.splits else None,
        "can_be_measured": counts.splits and (counts.templates or counts.evaluated),
        "best": best,
        # A template that is ready answers, whichever parts are chosen.
        "answers": counts.templates > counts.drafts + counts.disputed or answering_parts(world),
        "recent_runs": world.runs.for_table()[:6],
    }
    return render(request, "gpsr_site/world.html", context)


@world_view(Duty.VIEW, WRITE, does=NOTHING)
def close_first_steps(request: WorldRequest, world: World) -> HttpResponse:
    """Close the list of first steps for the reader, or show it again."""
    request.session[_steps_key(world)] = "close" in request.POST
    return redirect("world", world=world.name)


def _steps_key(world: World) -> str:
    return f"first_steps_closed_{world.pk}"


@never_cache
@plain_view()
def banner(request: HttpRequest) -> HttpResponse:
    """Show the worker's state, which every page asks for every two seconds."""
    return render(request, "gpsr_site/_banner.html")


@login_not_required
@plain_view()
def favicon(request: HttpRequest) -> HttpResponse:
    """Lead to the icon of the site, for which browsers ask here where a page names none, such as a file or JSON."""
    return redirect(static("dist/favicon.svg"))


@never_cache
@login_not_required
@plain_view()
def healthz(request: HttpRequest) -> HttpResponse:
    """Answer 200 where the database answers: for whoever supervises the process."""
    with connection.cursor() as cursor:
        cursor.execute("SELECT 1")
    return JsonResponse({"status": "ok"})
