"""Reports to download: one HTML file that opens without this site."""

from __future__ import annotations

from collections.abc import Iterator

from django.contrib import messages
from django.http import HttpRequest, HttpResponse, HttpResponseBase, StreamingHttpResponse
from django.shortcuts import get_object_or_404, redirect
from django.views.decorators.cache import never_cache

from annotations.models import Duty, World
from annotations.people.access import world_view
from parser_service.models import TrainingRun
from parser_service.reporting.run_report import part_of
from parser_service.reporting.run_report import run_report as write_run_report


@never_cache
@world_view(Duty.VIEW)
def run_report(request: HttpRequest, world: World, pk: int) -> HttpResponseBase:
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
