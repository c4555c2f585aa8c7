"""Learning curves: how accuracy grows with the training pairs; admins start the runs for them."""

from __future__ import annotations

from dataclasses import dataclass

from django.contrib import messages
from django.http import Http404, HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.language.texts import Refusal, say_count
from annotations.models import Duty, Split, World
from annotations.people.access import WRITE, WorldRequest, world_view
from parser_service.models import TrainingRun
from parser_service.parsers.conditions import (
    PAPERS_SETTINGS,
    SETTINGS,
    Protocol,
    Setting,
    settings_of,
)
from parser_service.results.learning_curves import LearningCurves, curves_url, learning_curves
from parser_service.results.measures import Measure
from parser_service.results.result_choices import PARTS, default_part, scored_splits
from parser_service.runs.learning_curve import MOST_SEEDS
from parser_service.runs.starting import start_learning_curve


@dataclass(frozen=True, slots=True)
class CurveChoices:
    """What an address chooses, or the defaults: what was trained last."""

    split: Split
    setting: Setting
    protocol: str
    part: str
    measure: Measure


@world_view(Duty.VIEW)
def learning_curves_page(request: WorldRequest, world: World) -> HttpResponse:
    """Show the curves of one column of the accuracy table."""
    return render(request, "parser_service/runs/learning_curves.html", context_of(request, world))


@never_cache
@world_view(Duty.VIEW)
def learning_curves_table(request: WorldRequest, world: World) -> HttpResponse:
    """Show the table alone; the page refreshes itself with it."""
    context = context_of(request, world)
    if context["shown"] is None:
        raise Http404("Nothing is trained in this world.")
    return render(request, "parser_service/runs/_learning_curves_table.html", context)


@never_cache
@world_view(Duty.VIEW)
def learning_curves_data(request: WorldRequest, world: World) -> JsonResponse:
    """Return the points as the chart reads them."""
    shown = context_of(request, world)["shown"]
    if isinstance(shown, LearningCurves):
        return JsonResponse(shown.chart)
    return JsonResponse({"series": [], "done": True})


@world_view(Duty.MANAGE, WRITE, does="start runs of a learning curve")
def learning_curve_start(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Start the missing runs of a run's learning curve, and show it."""
    run = get_object_or_404(TrainingRun, world=world, pk=pk)
    try:
        new = start_learning_curve(run, request.user, n_seeds_of(request.POST.get("seeds", "")))
    except Refusal as error:
        messages.error(request, error.message)
    else:
        there = "All runs of this learning curve have been asked for already."
        told = f"Started {say_count(len(new), 'run')} on shares of the training pairs."
        messages.info(request, told if new else there)
    test_source = request.POST.get("test", "")
    test_source = test_source if test_source in tested_with(run) else ""
    part = request.POST.get("part", "")
    return redirect(curves_url(world, run, test_source, part if part in PARTS else ""))


def n_seeds_of(text: str) -> int:
    """Return how many seeds are asked for: one unless ``text`` is a number up to ``MOST_SEEDS``."""
    return next((n for n in range(1, MOST_SEEDS + 1) if text == str(n)), 1)


def tested_with(run: TrainingRun) -> list[str]:
    """Return the test sources of the accuracy table for what ``run`` was trained on."""
    return [each.test_source for each in settings_of(run.train_sources)]


def context_of(request: WorldRequest, world: World) -> dict[str, object]:
    """Return the curves that the address chooses, and what else may be chosen; no curves without runs."""
    splits = scored_splits(world)
    choices = read_choices(request, world, splits)
    if choices is None:
        return {"shown": None}
    shown = learning_curves(
        world,
        choices.split,
        choices.setting,
        choices.protocol,
        choices.part,
        choices.measure,
    )
    return {
        "shown": shown,
        "choices": choices,
        "splits": splits,
        "settings": [
            (str(each), f"{each.train_sources} → {each.test_source}")
            for each in curve_settings(world, choices.setting)
        ],
        "protocols": list(Protocol),
        "parts": PARTS,
        "measures": list(Measure),
        "chart_title": f"{shown.measure.in_words.capitalize()} by training pairs, {choices.part} part",
        "query": request.GET.urlencode(),
    }


def curve_settings(world: World, chosen: Setting) -> list[Setting]:
    """Return the settings to choose from: those of the paper, those of the runs of ``world``, and ``chosen``."""
    trained = set(world.runs.scored_or_active().order_by().values_list("train_sources", flat=True))
    return [
        each
        for each in SETTINGS
        if each in PAPERS_SETTINGS or each == chosen or each.train_sources in trained
    ]


def read_choices(request: WorldRequest, world: World, splits: list[Split]) -> CurveChoices | None:
    """Read the address; for what it leaves out or misspells, take the choices of the newest run on the split."""
    asked = request.GET
    newest = world.runs.scored_or_active().order_by("-id").select_related("split")
    named = [split for split in splits if split.name == asked.get("split")]
    run = newest.filter(split__in=named).first() or newest.first()
    if run is None:
        return None
    settings = {str(each): each for each in SETTINGS}
    own = settings_of(run.train_sources)[0]
    part, measure = asked.get("part", ""), asked.get("measure", "")
    protocol = asked.get("protocol", "")
    return CurveChoices(
        split=run.split,
        setting=settings.get(asked.get("setting", ""), own),
        protocol=protocol if protocol in list(Protocol) else run.protocol,
        part=part if part in PARTS else default_part(world, splits=[run.split]),
        measure=Measure(measure) if measure in list(Measure) else Measure.EXACT,
    )
