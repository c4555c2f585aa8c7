"""Train the same configuration again on a split that was frozen anew."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.models import Duty, Split, World
from annotations.people.access import WRITE, world_view
from parser_service.models import TrainingRun
from parser_service.runs.requests.retraining import retrainable
from parser_service.runs.requests.starting import start_again
from parser_service.views.runs.run_new import in_words


@never_cache
@world_view(Duty.MANAGE)
def split_runs(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """List what was trained on the split before: a part of the page of a split that follows one."""
    row = get_object_or_404(Split.objects.select_related("follows"), world=world, pk=pk)
    context = {"split": row, "rows": retrainable(row)}
    return render(request, "parser_service/_split_runs.html", context)


@world_view(Duty.MANAGE, WRITE)
def run_retrain(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Start the configuration of a run on the newest split that follows its own."""
    run = get_object_or_404(
        TrainingRun.objects.select_related("split", "world"), world=world, pk=pk
    )
    try:
        answer = start_again(run, request.user)
    except ValueError as error:
        messages.warning(request, str(error))
        return redirect("run", world=world.name, pk=pk)
    if told := in_words([answer]):
        messages.info(request, told)
    return redirect("run", world=world.name, pk=answer[0].pk)
