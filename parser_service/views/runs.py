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
from parser_service import lifecycle, requesting
from parser_service.accuracy import seeds_url
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
    """The form that starts runs of the parser in the URL."""
    parser = request.GET.get("parser", "")
    parser = parser if parser in PARSERS else next(iter(PARSERS))
    initial = {"split": request.GET.get("split")}
    form = RunForm(world, parser, posted(request), initial=initial)
    if request.method == "POST" and form.is_valid():
        started = start(request, world, form)
        if len(started) == 1:
            return redirect("run", world=world.name, pk=started[0].pk)
        if started:
            return redirect(seeds_url(world, started[0]))
    context = {"form": form, "parsers": PARSERS, "chosen": parser, "entry": PARSERS[parser]}
    return render(request, "parser_service/run_new.html", context)


def start(request: HttpRequest, world: World, form: RunForm) -> list[TrainingRun]:
    """The runs that the form asks for, one a seed, new or already there; none where they are refused,
    with the reason in the form."""
    key = str(request.user.pk)
    if refusal := too_many(len(form.asked_seeds), STARTED_RUNS.left(key)):
        form.add_error(None, refusal)
        return []
    asked = {name: form.cleaned_data[name] for name in ("split", "protocol", "train_sources")}
    try:
        answers = requesting.request_seeds(
            world,
            parser=form.parser,
            config=form.config,
            by=request.user,
            seeds=form.asked_seeds,
            **asked,
        )
    except ValueError as error:
        form.add_error(None, str(error))
        return []
    for _ in answers:
        STARTED_RUNS.count(key)
    if told := in_words(answers):
        messages.info(request, told)
    return [run for run, _ in answers]


def too_many(asked: int, left: int) -> str:
    """Why a user who may start ``left`` more runs may not start ``asked``; empty where they may."""
    if asked <= left:
        return ""
    if left == 0:
        return (
            f"You have started {STARTED_RUNS.limit} runs within the hour. "
            "Wait for some of them before you start more."
        )
    return (
        f"{asked} runs are more than the {left} that you may still start within this hour. "
        "Ask for fewer seeds."
    )


def in_words(answers: list[tuple[TrainingRun, bool]]) -> str:
    """What a request came to; empty where it is one new run, which speaks for itself."""
    count, new = len(answers), sum(is_new for _, is_new in answers)
    if count == 1:
        return "" if new else "This has been trained already; here is that run."
    if not new:
        return f"All {count} seeds have been asked for already; here are their runs."
    first, last = answers[0][0].seed, answers[-1][0].seed
    started = f"Started {new} run{'s' if new > 1 else ''}, seeds {first} to {last}"
    if new == count:
        return f"{started}."
    return f"{started}; {count - new} {'was' if count - new == 1 else 'were'} there already."


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
    entry = PARSERS.get(run.parser)
    return {
        "run": run,
        "entry": entry,
        "loss_title": f"Loss by epoch, {entry.loss_unit if entry else 'nats'}",
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
