"""Which splits an edit makes stale: some of their commands no longer have the form they had."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice

from annotations.apps import workbench_apps
from annotations.models import Example, Split, World
from annotations.models.splits import Source
from annotations.rows.synchronise import batches

# Commands that are looked up; a change of more finds the splits that hold one of these.
MOST_COMMANDS = 2_000


@dataclass(frozen=True)
class StaleSplits:
    """The splits, and by the noun for them how many results were made with them."""

    splits: tuple[Split, ...] = ()
    results: tuple[tuple[str, int], ...] = ()


def stale_splits(world: World, forms_before: Mapping[str, str]) -> StaleSplits:
    """Return the splits of ``world`` whose generated pairs hold one of ``forms_before``, command → form."""
    keys: set[int] = set()
    of_world = Example.objects.filter(split__world=world, source=Source.GENERATED).order_by()
    for commands in batches(islice(forms_before, MOST_COMMANDS)):
        pairs = of_world.filter(utterance__in=commands).exclude(split__in=keys)
        for key, command, form in pairs.values_list("split", "utterance", "logical_form"):
            if form == forms_before[command]:
                keys.add(key)
    if not keys:
        return StaleSplits()
    counts = (count for app in workbench_apps() for count in app.results_of(keys).items())
    return StaleSplits(
        tuple(Split.objects.filter(pk__in=keys)), tuple(count for count in counts if count[1])
    )
