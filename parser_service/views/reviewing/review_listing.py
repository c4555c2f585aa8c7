"""The runs and examples that the address of the review page names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from django.db.models import Count, Exists, Max, Min, OuterRef, Q, QuerySet
from django.http import Http404, HttpRequest, QueryDict
from django.shortcuts import get_object_or_404

from annotations.lists.listing import Listing, Sort
from annotations.models import Example, World
from parser_service.models import Prediction, TrainingRun
from parser_service.parsers.registry import PARSERS
from parser_service.reviewing.filters import ReviewFilters

MOST_RUNS = 6
PLACES = ("example", "from", "focus")
SORTS = {"position": Sort("No.", "example_id", is_number=True)}


def number_of(text: str) -> int:
    """Return the key that an address names; 0, which no row has, for what is none."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 19 else 0


def runs_asked(request: HttpRequest, world: World) -> list[TrainingRun]:
    """Return the runs that the address names, in its order; without any the newest one with answers.

    Those of another split than the first are left out. Raises Http404 where the world has no such run.
    """
    given = [text for text in request.GET.getlist("run") if text]
    keys = list(dict.fromkeys(map(number_of, given)))[:MOST_RUNS]
    rows = TrainingRun.objects.filter(world=world).select_related("split")
    if not keys:
        newest = _with_answers(rows).order_by("-pk").first()
        return [newest] if newest else []
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
    return [(key, f"{_title(parser)}, run {key}, on {on}") for key, parser, on in rows]


def _title(parser: str) -> str:
    return PARSERS[parser].title if parser in PARSERS else parser


class ReviewListing(Listing):
    """The examples that the filters leave, in the order of the split, as the first run answers them."""

    def __init__(self, request: HttpRequest, runs: Sequence[TrainingRun]):
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

    @property
    def clear_url(self) -> str:
        return self.url(**dict.fromkeys(self.form.fields, ""))

    @property
    def first_fields(self) -> list[Any]:
        """The filters that one sees at once; where the runs differ is asked by a button of its own."""
        return [field for field in super().first_fields if field.name != "differ"]

    @cached_property
    def differ_url(self) -> str:
        return self.url(differ="" if self.query.get("differ") else "1")

    def first_from(self, example: int) -> int | None:
        """Return the first example of the list at or behind ``example``; the first of all where none is."""
        keys = self.matching.order_by("example_id").values_list("example_id", flat=True)
        return keys.filter(example_id__gte=example).first() or keys.first()

    def place_of(self, example: Example) -> Place:
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
        return Place(number=found.pop("n_before") + 1, is_inside=is_inside, **found)


@dataclass(frozen=True, slots=True)
class Place:
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


def example_asked(request: HttpRequest, listing: ReviewListing, split: int) -> Example | None:
    """Return the example that the address names, or the first of the list. Raises Http404 for one of
    another split."""
    key = request.GET.get("example")
    found = number_of(key) if key else listing.first_from(0)
    if found is None:
        return None
    return get_object_or_404(Example.objects.select_related("split__world"), split=split, pk=found)
