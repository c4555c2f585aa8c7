"""The review page: one example, what each run makes of it, and what reviewers say about that."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from django.contrib import messages
from django.db.models import Count, Exists, Max, Min, OuterRef, Q, QuerySet
from django.http import Http404, HttpResponse, QueryDict
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.utils.http import urlencode
from django.views.decorators.cache import never_cache

from annotations.language.corpus import Part
from annotations.language.texts import Refusal
from annotations.models import Duty, Example, World
from annotations.people.access import WRITE, WorldRequest, world_view
from annotations.showing.keys import KEYS, keys_for
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.own_entities import OwnEntities
from annotations.showing.paging import number_in
from parser_service.models import Prediction, TrainingRun
from parser_service.parsers.registry import title_of
from parser_service.reviews.cases import read_case
from parser_service.reviews.label_doubts import LONGEST_DOUBT, doubt_label
from parser_service.reviews.review_filters import ReviewFilters
from parser_service.reviews.tagging import LONGEST_NOTE, accept, tag, take_back_review, write_note
from parser_service.reviews.world_categories import ensure_categories
from parser_service.serving.default_runs import opening_run

# What the first categories are tagged with; later ones are clicked.
CATEGORY_KEYS = KEYS["digit"].keys
PAGE_KEYS = keys_for(
    *("next", "previous", "left", "right", "digit", "accept", "undo", "note", "edit", "dispute"),
    *("queue", "filters", "differ", "beside", "tree", "candidates", "all"),
)

MOST_RUNS = 6
PLACES = ("example", "from", "focus")
SORTS = {"position": Sort("No.", "example_id", is_number=True)}


@never_cache
@world_view(Duty.VIEW)
def review(request: WorldRequest, world: World) -> HttpResponse:
    """Show the example that the address names, or the first that its filters leave.

    An address that asks for nothing leads to the first wrong answer of the run that pages open on.
    """
    runs = runs_asked(request, world)
    if not runs:
        return render_list(request, "parser_service/reviews/review.html", {"runs": []})
    if not request.GET:
        return redirect(f"{request.path}?{opening_query(runs[0])}")
    listing = ReviewListing(request, runs)
    if start := request.GET.get("from"):
        found = listing.first_from(number_in(start))
        return redirect(f"{request.path}{listing.url(example=str(found) if found else '')}")
    example = example_asked(request, listing, runs[0].split_id)
    context = {
        "runs": runs,
        "listing": listing,
        "page_keys": PAGE_KEYS,
        "case": None,
    }
    if example is not None:
        context |= _context_of(request, listing, runs, example)
        context["place"] = listing.place_of(example)
    return render_list(request, "parser_service/reviews/review.html", context)


@world_view(Duty.REVIEW, WRITE, does="tag an answer")
def review_tag(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Tag the answer of one run, accept what is proposed, or take the reader's tag back."""
    sent = request.POST
    steps: dict[str, Callable[..., Any]] = {"accept": accept, "take_back": take_back_review}

    def change(run: TrainingRun, example: Example) -> None:
        if sent.get("step") in steps:
            steps[sent["step"]](run, example, request.user)
            return
        key = number_in(sent.get("category", ""))
        category = world.error_categories.filter(pk=key).first()
        if category is None:
            raise Refusal("This error category is gone. Reload the page.", "unknown_error_category")
        tag(run, example, category, request.user)

    return _change(request, world, pk, change)


@world_view(Duty.REVIEW, WRITE, does="write a note on an answer")
def review_note(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Keep the reader's note on the answer of one run; an empty one is removed."""
    note = request.POST.get("note", "")
    return _change(
        request, world, pk, lambda run, example: write_note(run, example, note, request.user)
    )


@world_view(Duty.REVIEW, WRITE, does="doubt a label")
def review_doubt(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Send the label of the example to the work queue."""
    sent = request.POST

    def change(run: TrainingRun, example: Example) -> str:
        reason = sent.get("reason", "")[:LONGEST_DOUBT]
        return doubt_label(example, reason, request.user, sent.get("right", ""))

    return _change(request, world, pk, change)


def _change(
    request: WorldRequest,
    world: World,
    pk: int,
    change: Callable[[TrainingRun, Example], Any],
) -> HttpResponse:
    """Do ``change`` for the run that was sent and the example ``pk``, and show the example again."""
    shown = runs_asked(request, world)
    key = number_in(request.POST.get("run", "")) or (shown[0].pk if shown else 0)
    run = get_object_or_404(TrainingRun.objects.filter(world=world), pk=key)
    example = get_object_or_404(
        Example.objects.select_related("split__world"), split=run.split_id, pk=pk
    )
    problem, said = "", ""
    try:
        outcome = change(run, example)
        said = outcome if isinstance(outcome, str) else ""
    except Refusal as error:
        problem = error.message
    if not request.htmx:
        if problem or said:
            level = messages.ERROR if problem else messages.SUCCESS
            messages.add_message(request, level, problem or said)
        address = reverse("review", kwargs={"world": world.name})
        state = ReviewListing(request, shown).url(example=str(example.pk), focus=str(run.pk))
        return redirect(f"{address}{state}")
    context = _context_of(request, ReviewListing(request, shown), shown, example)
    context |= {"problem": problem, "said": said, "focus": run.pk}
    return render(request, "parser_service/reviews/_review_case.html", context)


def _context_of(
    request: WorldRequest, listing: ReviewListing, runs: list[TrainingRun], example: Example
) -> dict[str, Any]:
    """Return what one example is shown with; ``state`` is the list that it is in, for its forms."""
    case = read_case(runs, example, request.user)
    categories = ensure_categories(request.world).values()
    asked = number_in(request.GET.get("focus", ""))
    keys = [run.pk for run in runs]
    address = reverse("review", kwargs={"world": request.world.name})
    here = str(example.pk)
    return {
        "case": case,
        "own": OwnEntities.of_pair(request.world, example),
        "runs": runs,
        "answers": [
            (each, listing.url(listing.runs_without(each.run), example=here))
            for each in case.answers
        ],
        "addable": runs_to_add(runs),
        "here": f"{address}{listing.url(example=here)}",
        "listing": listing,
        "state": listing.url(),
        "categories": [
            (each, CATEGORY_KEYS[place] if place < len(CATEGORY_KEYS) else "")
            for place, each in enumerate(categories)
        ],
        "focus": asked if asked in keys else case.first_to_read,
        "longest_note": LONGEST_NOTE,
        "longest_doubt": LONGEST_DOUBT,
    }


def opening_query(run: TrainingRun) -> str:
    """Return the address of what ``run`` answers wrongly on the validation part; that of all answers where there is
    nothing of this kind. The test part is left alone: who reads its errors tests on it no more."""
    chosen = {"run": str(run.pk)}
    wrong = {"outcome": "wrong", "part": str(Part.VALIDATION)}
    rows = run.predictions.best().filter(is_exact_match=False, example__part=Part.VALIDATION)
    return urlencode(chosen | wrong if rows.exists() else chosen)


def runs_asked(request: WorldRequest, world: World) -> list[TrainingRun]:
    """Return the runs that the address names, in its order; without any the one that pages open on.

    Those of another split than the first are left out. Raises Http404 where the world has no such run.
    """
    given = [text for text in request.GET.getlist("run") if text]
    keys = list(dict.fromkeys(map(number_in, given)))[:MOST_RUNS]
    rows = TrainingRun.objects.filter(world=world).select_related("split")
    if not keys:
        with_answers = _with_answers(rows)
        opening = opening_run(world)
        of_opening = with_answers.filter(pk=opening.pk).first() if opening else None
        first = of_opening or with_answers.order_by("-pk").first()
        return [first] if first else []
    by_key = rows.in_bulk(keys)
    if len(by_key) < len(keys):
        raise Http404("This world has no such run.")
    runs = [by_key[key] for key in keys]
    return [run for run in runs if run.split_id == runs[0].split_id]


def _with_answers(runs: QuerySet[TrainingRun]) -> QuerySet[TrainingRun]:
    return runs.filter(Exists(Prediction.objects.filter(run=OuterRef("pk"))))


def runs_to_add(runs: Sequence[TrainingRun]) -> list[tuple[int, str]]:
    """Return key and name of the runs that can be shown beside these, the newest first."""
    if not runs or len(runs) >= MOST_RUNS:
        return []
    of_split = TrainingRun.objects.filter(world=runs[0].world_id, split=runs[0].split_id)
    others = _with_answers(of_split).exclude(pk__in=[run.pk for run in runs])
    rows = others.order_by("-pk").values_list("pk", "parser", "train_sources")
    return [(key, f"{title_of(parser)}, run {key}, on {on}") for key, parser, on in rows]


class ReviewListing(Listing):
    """The examples that the filters leave, in the order of the split, as the first run answers them."""

    def __init__(self, request: WorldRequest, runs: Sequence[TrainingRun]):
        rows = runs[0].predictions.best()
        super().__init__(request, ReviewFilters, rows, SORTS, runs=runs, of_run=runs[0])
        self.runs = [str(run.pk) for run in runs]

    def url(self, runs: Sequence[str] | None = None, **changes: str) -> str:
        """Return the address of this list with ``changes`` and other ``runs``; an empty value is removed."""
        query = QueryDict(mutable=True)
        query.setlist("run", self.runs if runs is None else list(runs))
        for name, values in QueryDict(super().url(**changes).removeprefix("?")).lists():
            if name != "run" and (name in changes or name not in PLACES):
                query.setlist(name, values)
        return f"?{query.urlencode(safe='/')}"

    def runs_without(self, run: TrainingRun) -> list[str]:
        return [key for key in self.runs if key != str(run.pk)]

    @property
    def clear_url(self) -> str:
        return self.url(**dict.fromkeys(self.form.fields, ""))

    @property
    def fields(self) -> list[Any]:
        """The filters behind the button; ``where the runs differ`` is not among them, since it has its own."""
        return [field for field in self.form if field.name != "differ"]

    @cached_property
    def differ_url(self) -> str:
        return self.url(differ="" if self.query.get("differ") else "1")

    def first_from(self, example: int) -> int | None:
        """Return the first example of the list at or behind ``example``, or else the first of all."""
        keys = self.matching.order_by("example_id").values_list("example_id", flat=True)
        return keys.filter(example_id__gte=example).first() or keys.first()

    def place_of(self, example: Example) -> PlaceInList:
        """Return where ``example`` stands in the list. One pass, for filters that cost time at each row."""
        before, after = Q(example_id__lt=example.pk), Q(example_id__gt=example.pk)
        found = self.matching.order_by().aggregate(
            before=Max("example_id", filter=before),
            after=Min("example_id", filter=after),
            n_before=Count("pk", filter=before),
            n_after=Count("pk", filter=after),
            total=Count("pk"),
        )
        is_inside = found["total"] > found["n_before"] + found.pop("n_after")
        return PlaceInList(number=found.pop("n_before") + 1, is_inside=is_inside, **found)


@dataclass(frozen=True, slots=True)
class PlaceInList:
    """Neighbours of an example in the list, its number from 1, and how many there are; ``is_inside`` is
    false for an example that the filters leave out."""

    before: int | None
    after: int | None
    number: int
    total: int
    is_inside: bool

    @property
    def summary(self) -> str:
        """Such as ``12 of 340``; for an example outside the list how many are in it."""
        return f"{self.number:,} of {self.total:,}" if self.is_inside else f"{self.total:,}"


def example_asked(request: WorldRequest, listing: ReviewListing, split: int) -> Example | None:
    """Return the example that the address names, or the first of the list. Raises Http404 for one of
    another split."""
    key = request.GET.get("example")
    found = number_in(key) if key else listing.first_from(0)
    if found is None:
        return None
    return get_object_or_404(Example.objects.select_related("split__world"), split=split, pk=found)
