"""Reports to download: one HTML file that opens without this site."""

from __future__ import annotations

from collections.abc import Iterator

from django.contrib import messages
from django.http import HttpResponse, HttpResponseBase, StreamingHttpResponse
from django.shortcuts import get_object_or_404, redirect
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.models import Duty, World
from annotations.people.access import WorldRequest, world_view
from annotations.people.allowances import may_take_long
from parser_service.models import TrainingRun
from parser_service.results.compared import compare_on
from parser_service.results.result_choices import default_part
from parser_service.results.run_choice import PARTS, choose_runs, named_keys
from parser_service.reviews.comparison_report import comparison_report
from parser_service.reviews.run_report import part_of
from parser_service.reviews.run_report import run_report as write_run_report
from parser_service.web.results.compare_pages import ComparedFilters, measure_of


@never_cache
@may_take_long
@world_view(Duty.VIEW)
def run_report(request: WorldRequest, world: World, pk: int) -> HttpResponseBase:
    """Download the report of a run; ``part`` says on which part of its split."""
    runs = TrainingRun.objects.for_table().select_related("world", "split", "created_by")
    run = get_object_or_404(runs, world=world, pk=pk)
    part = part_of(run, request.GET.get("part", ""))
    if part is None:
        messages.info(request, "There is nothing to report before the run has been tested.")
        return redirect("run", world=world.name, pk=pk)
    return as_download(write_run_report(run, part), f"{world.name}-run-{pk}-{part}.html")


def as_download(pieces: Iterator[str], name: str) -> HttpResponse | StreamingHttpResponse:
    """Send an HTML file in pieces. The browser stores it, so that no page of this site is made of it."""
    return StreamingHttpResponse(
        pieces,
        content_type="text/html; charset=utf-8",
        headers={"Content-Disposition": f'attachment; filename="{name}"'},
    )


@never_cache
@may_take_long
@world_view(Duty.VIEW)
def compare_report(request: WorldRequest, world: World) -> HttpResponseBase:
    """Download the comparison that the compare page shows at the same address."""
    part = request.GET.get("part", "")
    part = part if part in PARTS else default_part(world, named_keys(request.GET))
    choice = choose_runs(world, request.GET, part)
    filters = ComparedFilters(request)
    page = f"{reverse('compare', kwargs={'world': world.name})}?{request.GET.urlencode()}"
    if len(choice.runs) < 2:
        messages.info(request, "Choose two runs or more to report how they compare.")
        return redirect(page)
    compared = compare_on(world, choice.runs, choice.part, filters.filters, measure_of(request))
    if not compared.count:
        messages.info(request, "There is no example in this slice to report about.")
        return redirect(page)
    chosen = [(chip.label, chip.value) for chip in filters.chips]
    name = f"{world.name}-runs-{'-'.join(str(run.pk) for run in choice.runs)}-{part}.html"
    return as_download(comparison_report(compared, choice.names, chosen), name)
