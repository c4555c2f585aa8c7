"""The runs that the URL of a page names: ``?run=3&run=7``, on Parse ``?beside=3&beside=7``."""

from __future__ import annotations

from django.db.models import QuerySet
from django.http import QueryDict

from annotations.models import World
from annotations.showing.paging import number_in
from parser_service.models import TrainingRun

MOST_RUNS = 4


def asked_runs(query: QueryDict, world: World, field: str = "run") -> list[TrainingRun]:
    """Return the succeeded runs of the world that ``field`` of the URL names, in its order, ``MOST_RUNS`` at most."""
    keys = list(dict.fromkeys(map(number_in, query.getlist(field))))
    rows: QuerySet[TrainingRun] = world.runs.succeeded().select_related("split", "world")
    runs = rows.in_bulk(keys[:100])
    return [runs[key] for key in keys if key in runs][:MOST_RUNS]


def runs_to_choose(world: World, most: int = 50) -> QuerySet[TrainingRun]:
    """Return the newest succeeded runs of the world."""
    return world.runs.succeeded().select_related("split").order_by("-pk")[:most]
