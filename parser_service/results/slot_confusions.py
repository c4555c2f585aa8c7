"""The confusion of slots that a worker has found, as lines of a table."""

from __future__ import annotations

from dataclasses import dataclass

from django.urls import reverse
from django.utils.http import urlencode

from annotations.models import World
from parser_service.models import TrainingRun

SLOTS = "slots"  # the name of this analysis among the findings of a run
MOST_ROWS = 40


@dataclass(frozen=True, slots=True)
class SlotRow:
    """Argument ``place`` of ``predicate`` is ``gold`` in ``count`` labels and ``predicted`` in the answers to them."""

    predicate: str
    place: int
    gold: str
    predicted: str
    count: int
    url: str


def slot_rows(world: World, run: TrainingRun, part: str) -> list[SlotRow] | None:
    """Return the most frequent confusions of a run's answers on a part; None where they are not analysed yet."""
    stored = run.analyses.filter(part=part).values_list(f"findings__{SLOTS}__rows", flat=True)
    confusions = stored.first()
    if confusions is None:
        return None
    path = reverse("predictions", kwargs={"world": world.name, "pk": run.pk})
    rows = []
    for predicate, place, gold, predicted, count in confusions[:MOST_ROWS]:
        confusion = f"{run.pk}:{predicate}:{place}:{gold}:{predicted}"
        url = f"{path}?{urlencode({'part': part, 'slot': confusion})}"
        rows.append(SlotRow(predicate, place, gold, predicted, count, url))
    return rows
