"""Verb: select the predictions of a slice."""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace

from django.db.models import QuerySet
from django.http import QueryDict

from annotations.models import World
from parser_service.models import Prediction, TrainingRun
from parser_service.results.prediction_filters import PredictionFilters

# What belongs to a page rather than to a slice: which part it is about, and what another run or analysis says.
OF_A_PAGE = ("part", "slice", "slot", "versus", "versus_outcome")


def select(
    rows: TrainingRun | QuerySet[Prediction],
    query: str | Mapping[str, object],
    world: World | None = None,
) -> QuerySet[Prediction]:
    """Return the first answers that a query chooses.

    Args:
        rows: a run, or predictions of rank 1.
        query: parameters of ``PredictionFilters`` as a URL has them. What they do not know is left out.
        world: whose error categories and slices the query means; that of the run unless given.

    Raises:
        ValueError: there are predictions but no world.
    """
    if isinstance(rows, TrainingRun):
        of_run = filters_of(world or rows.world, query, rows.predictions.best(), rows)
        chosen: QuerySet[Prediction] = of_run.qs
        return chosen
    if world is None:
        raise ValueError("Predictions alone do not tell which world a query is about.")
    chosen = filters_of(world, query, rows).qs
    return chosen


def filters_of(
    world: World,
    query: str | Mapping[str, object],
    rows: QuerySet[Prediction] | None = None,
    of_run: TrainingRun | None = None,
) -> PredictionFilters:
    """Return the filters that a query sets, over ``rows``, which are ``of_run`` where they are of one."""
    data = QueryDict(query) if isinstance(query, str) else query
    rows = Prediction.objects.none() if rows is None else rows
    return PredictionFilters(data, rows, request=SimpleNamespace(world=world), of_run=of_run)


def slice_query(world: World, query: str | Mapping[str, object]) -> str:
    """Return what a query says of a slice: its filters in their order, without what belongs to a page.

    A saved slice that it names is written out; filters beside it count more. Two queries for the same slice
    give the same text; it is empty where every prediction is chosen.
    """
    filters = filters_of(world, query)
    given = filters.given
    if key := given.get("slice"):
        saved = world.slices.values_list("query", flat=True).get(pk=key)
        given = filters_of(world, saved).given | given
    written = QueryDict(mutable=True)
    for name in filters.filters:
        if name in given and name not in OF_A_PAGE:
            written[name] = str(given[name])
    return written.urlencode()


def describe_query(world: World, query: str) -> list[tuple[str, str]]:
    """Return label and value of each filter that a query sets, as a page names them."""
    filters = filters_of(world, query)
    described = []
    for name, value in filters.given.items():
        field = filters.form.fields[name]
        choices = dict(getattr(field, "choices", ()))
        described.append((str(field.label), str(choices.get(value, value))))
    return described
