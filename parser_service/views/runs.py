"""Training runs: everybody watches, admins start and cancel."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.access import READ_AND_WRITE, WRITE, world_view
from annotations.forms import posted
from annotations.listing import Listing, Sort
from annotations.models import Duty, World
from annotations.rates import STARTED_RUNS
from parser_service import lifecycle
from parser_service.curves import CURVES, loss_curves
from parser_service.filters import RunFilters
from parser_service.forms import RunForm
from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers.registry import PARSERS

SORTS = {
    "newest": Sort("Run", "-id", is_number=True),
    "parser": Sort("Parser", "parser"),
    "status": Sort("Status", "status"),
    "seconds": Sort("Trained", "seconds_trained", is_number=True),
}
TEST_SOURCES = ("gen", "para", "mixed")
TOO_MANY = (
    f"You have started {STARTED_RUNS.limit} runs within the hour. "
    "Wait for some of them before you start more."
)


@world_view(Duty.VIEW)
def runs(request: HttpRequest, world: World) -> HttpResponse:
    """All runs, newest first."""
    return render(request, "parser_service/runs.html", {"listing": runs_of(request, world)})


@never_cache
@world_view(Duty.VIEW)
def runs_table(request: HttpRequest, world: World) -> HttpResponse:
    """The table of the page alone, for the page to refresh itself with."""
    return render(request, "parser_service/_runs_table.html", {"listing": runs_of(request, world)})


def runs_of(request: HttpRequest, world: World) -> Listing:
    return Listing(request, RunFilters, world.runs.for_table(), SORTS)


@world_view(Duty.MANAGE, READ_AND_WRITE)
def run_new(request: HttpRequest, world: World) -> HttpResponse:
    """The form that starts a run of the parser in the URL."""
    parser = request.GET.get("parser", "")
    parser = parser if parser in PARSERS else next(iter(PARSERS))
    initial = {"split": request.GET.get("split")}
    form = RunForm(world, parser, posted(request), initial=initial)
    if request.method == "POST" and form.is_valid():
        run = start(request, world, form)
        if run:
            return redirect("run", world=world.name, pk=run.pk)
    context = {"form": form, "parsers": PARSERS, "chosen": parser, "entry": PARSERS[parser]}
    return render(request, "parser_service/run_new.html", context)


def start(request: HttpRequest, world: World, form: RunForm) -> TrainingRun | None:
    """The run that the form asks for, new or already there; None where it is refused, with the reason
    in the form."""
    key = str(request.user.pk)
    if STARTED_RUNS.is_spent(key):
        form.add_error(None, TOO_MANY)
        return None
    asked = {
        name: form.cleaned_data[name] for name in ("split", "protocol", "train_sources", "seed")
    }
    try:
        run, is_new = lifecycle.request(
            world, parser=form.parser, config=form.config, by=request.user, **asked
        )
    except ValueError as error:
        form.add_error(None, str(error))
        return None
    STARTED_RUNS.count(key)
    if not is_new:
        messages.info(request, "This has been trained already; here is that run.")
    return run


@world_view(Duty.VIEW)
def run(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """One run: progress, curves, log and what came of it."""
    return render(request, "parser_service/run.html", state_of(world, pk))


@never_cache
@world_view(Duty.VIEW)
def run_state(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """What changes on the page of a run while it works."""
    context = {**state_of(world, pk), "is_update": True}
    return render(request, "parser_service/_run_state.html", context)


def state_of(world: World, pk: int) -> dict[str, object]:
    run = get_object_or_404(TrainingRun.objects.for_table(), world=world, pk=pk)
    return {
        "run": run,
        "entry": PARSERS.get(run.parser),
        "evaluations": sorted(run.evaluations.all(), key=order_of),
        "epochs": list(run.epochs.all()),
        "events": list(run.events.order_by("-id")[:200])[::-1],
        "checkpoints": run.checkpoints.all(),
    }


def order_of(score: Evaluation) -> tuple[str, int]:
    """Parts together, the sources in the order in which they are named everywhere."""
    return score.part, TEST_SOURCES.index(score.test_source)


@never_cache
@world_view(Duty.VIEW)
def run_curves(request: HttpRequest, world: World, pk: int) -> JsonResponse:
    """Loss or accuracy by epoch, as the charts read them."""
    run = get_object_or_404(TrainingRun, world=world, pk=pk)
    draw = CURVES.get(request.GET.get("show", ""), loss_curves)
    return JsonResponse({**draw(list(run.epochs.all())), "done": run.is_ended})


@world_view(Duty.MANAGE, WRITE)
def run_cancel(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Stops a run within seconds."""
    run = get_object_or_404(TrainingRun, world=world, pk=pk)
    try:
        lifecycle.cancel(run)
    except ValueError as error:
        messages.warning(request, str(error))
    return redirect("run", world=world.name, pk=pk)
