"""Compare runs: is the difference real, and where is it?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django.http import HttpResponse, QueryDict
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.language.corpus import Criterion
from annotations.models import Duty, World
from annotations.people.access import NOTHING, WRITE, PageRequest, WorldRequest, world_view
from annotations.showing.listing import FilteredList
from annotations.showing.paging import number_in
from parser_service.models import Prediction, TrainingRun
from parser_service.models.evaluations import ShownScore
from parser_service.results.addresses import Addresses
from parser_service.results.breakdown import accuracies_of, break_down, break_down_by_slices
from parser_service.results.compared import compare_on
from parser_service.results.comparison_tables import confusion_table, pair_rows, win_matrix
from parser_service.results.configurations import difference_of
from parser_service.results.measures import OF_EXAMPLES, Measure
from parser_service.results.prediction_filters import PredictionFilters
from parser_service.results.result_choices import default_part
from parser_service.results.run_choice import LETTERS, PARTS, RunChoice, choose_runs, named_keys
from parser_service.results.selecting import slice_query
from parser_service.results.slot_confusions import slot_rows
from parser_service.reviews.state import analysis_of

OF_THE_PAGE = ("part", "versus", "versus_outcome", "slot")


class ComparedFilters(FilteredList):
    """The filters of a comparison, without the part, which has buttons."""

    further = PredictionFilters.further

    def __init__(self, request: PageRequest) -> None:
        self.query = request.GET
        self.filters = PredictionFilters(request.GET, Prediction.objects.none(), request=request)
        self.form = self.filters.form

    @property
    def first_fields(self) -> list[Any]:
        return [field for field in super().first_fields if field.name not in OF_THE_PAGE]

    @property
    def chips(self) -> list[Any]:
        part = str(self.form.fields["part"].label)
        return [chip for chip in super().chips if chip.label != part]

    @property
    def chosen(self) -> dict[str, str]:
        """The filters that are set, as a URL has them."""
        given = self.filters.given
        return {name: str(value) for name, value in given.items() if name not in OF_THE_PAGE}

    @property
    def clear_url(self) -> str:
        return self.url(**dict.fromkeys(self.chosen, ""))


@world_view(Duty.VIEW)
def compare(request: WorldRequest, world: World) -> HttpResponse:
    """Compare the runs that the URL names on the slice that it chooses, or offer runs to choose from.

    One run alone is shown by its slices and confusions; with a baseline of the reader, its URL leads to both. A URL
    that names none leads to that of the two best, or of the baseline and the best beside it.
    """
    part = request.GET.get("part", "")
    part = part if part in PARTS else default_part(world, named_keys(request.GET))
    choice = choose_runs(world, request.GET, part)
    baseline = baseline_of(request, world)
    if opening := opening_runs(world, choice, baseline, is_named="run" in request.GET):
        return redirect(f"{request.path}{url_with_runs(request, opening)}")
    filters = ComparedFilters(request)
    measure = measure_of(request)
    context = {
        "choice": choice,
        "baseline": baseline,
        "parts": PARTS,
        "filters": filters,
        "lettered": list(zip(LETTERS, choice.runs, strict=False)),
        "part_urls": [(each, filters.url(part=each)) for each in PARTS],
        "measure": measure,
        "measure_urls": [(each, filters.url(measure=each)) for each in OF_EXAMPLES],
        "suggestion_url": url_with_runs(request, choice.suggested),
        "slice_query": slice_query(world, request.GET),
    }
    if choice.runs:
        context |= comparison_of(request, world, choice, filters, measure)
    return render(request, "parser_service/results/compare.html", context)


@world_view(Duty.VIEW, WRITE, does=NOTHING)
def compare_baseline(request: WorldRequest, world: World) -> HttpResponse:
    """Pin a run as the baseline of what the reader compares here, or unpin it; ``query`` is the page's address."""
    query = QueryDict(request.POST.get("query", ""), mutable=True)
    run = world.runs.succeeded().filter(pk=number_in(request.POST.get("run", ""))).first()
    request.session[_baseline_key(world)] = run.pk if run else None
    if run:
        others = [key for key in named_keys(query) if key != run.pk]
        query.setlist("run", [str(key) for key in (run.pk, *others)])
    return redirect(f"{reverse('compare', args=[world.name])}?{query.urlencode()}")


def baseline_of(request: WorldRequest, world: World) -> TrainingRun | None:
    """Return the run that the reader has pinned in this world; it stays until they unpin it or log out."""
    key = request.session.get(_baseline_key(world))
    return world.runs.succeeded().filter(pk=key).first() if key else None


def _baseline_key(world: World) -> str:
    return f"baseline_{world.pk}"


def opening_runs(
    world: World, choice: RunChoice, baseline: TrainingRun | None, is_named: bool
) -> list[TrainingRun]:
    """Return the runs to go on to from an address that names fewer than two; none where it stays as it is."""
    if baseline is None or len(choice.runs) > 1:
        return [] if is_named else choice.opening
    beside = [run for run in choice.runs if run != baseline]
    if not beside:
        offered = choose_runs(world, QueryDict(f"run={baseline.pk}"), choice.part).offered
        ranked = sorted(offered, key=lambda each: -each.accuracy)
        beside = [each.run for each in ranked if each.run != baseline][:1]
    is_of_one_split = all(run.split_id == baseline.split_id for run in beside)
    return [baseline, *beside] if beside and is_of_one_split else []


def measure_of(request: PageRequest) -> Measure:
    """Return the measure that the address chooses; exact match where it names none by which runs are compared."""
    asked = request.GET.get("measure", "")
    return next((each for each in OF_EXAMPLES if each == asked), Measure.EXACT)


def comparison_of(
    request: WorldRequest,
    world: World,
    choice: RunChoice,
    filters: ComparedFilters,
    measure: Measure,
) -> dict[str, Any]:
    """Return what the page says about the runs."""
    compared = compare_on(world, choice.runs, choice.part, filters.filters, measure)
    addresses = Addresses(world, choice.runs, choice.part, filters.chosen, measure)
    if not compared.count:
        return {"compared": compared}
    place = confused_run(request, choice.runs)
    slots = slot_rows(world, choice.runs[place], choice.part)
    return {
        "slots": slots,
        "analysis": analysis_of(choice.runs[place]) if slots is None else None,
        "compared": compared,
        "configuration": difference_of(choice.runs) if len(choice.runs) > 1 else None,
        "accuracies": list(
            zip(LETTERS, choice.runs, accuracies_of(compared, addresses), strict=False)
        ),
        "matrix": win_matrix(compared, addresses),
        "pairs": pair_rows(compared, choice.names),
        "by_form": scores_by_form(choice),
        "breakdowns": break_down(compared, addresses),
        "saved": break_down_by_slices(compared, addresses),
        "heat": confusion_table(compared, place, addresses),
        "confused": choice.runs[place],
        "confusion_urls": [
            (letter, run, filters.url(confusion=str(run.pk)))
            for letter, run in zip(LETTERS, choice.runs, strict=False)
        ],
    }


def scores_by_form(choice: RunChoice) -> list[tuple[str, TrainingRun, Sequence[ShownScore]]]:
    """Return letter, run and scores on the whole part for each compared run, if the split is by form: the
    compared examples have only unseen forms. Nothing for other splits."""
    if choice.split is None or choice.split.criterion != Criterion.LOGICAL_FORM:
        return []
    scores = {each.run: tuple(each.scores.values()) for each in choice.offered}
    return [(letter, run, scores[run]) for letter, run in zip(LETTERS, choice.runs, strict=False)]


def confused_run(request: PageRequest, runs: Sequence[TrainingRun]) -> int:
    """Return the place of the run whose confusions are shown."""
    key = request.GET.get("confusion", "")
    return next((place for place, run in enumerate(runs) if str(run.pk) == key), 0)


def url_with_runs(request: PageRequest, runs: Sequence[TrainingRun]) -> str:
    """Return the address of this page with other runs."""
    query = request.GET.copy()
    query.setlist("run", [str(run.pk) for run in runs])
    return f"?{query.urlencode()}"
