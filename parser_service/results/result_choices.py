"""What the address of the results page chooses to show. Its downloads read the same address."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from django.http import QueryDict
from django.utils.http import urlencode

from annotations.language.corpus import Part
from annotations.models import Split, World
from parser_service.results.accuracy_tables import accuracy_tables
from parser_service.results.measures import Measure
from parser_service.results.table_parts import AccuracyTable

PARTS = (Part.VALIDATION, Part.TEST)
MOST_SPLITS = 4  # side by side without a choice
# The measures side by side, by the word in the address; the first is the default.
MEASURES = {
    "exact": (Measure.EXACT,),
    "equivalent": (Measure.EQUIVALENT,),
    "same_plan": (Measure.SAME_PLAN,),
    "all": (Measure.EXACT, Measure.EQUIVALENT, Measure.SAME_PLAN),
    "well_formed": (Measure.WELL_FORMED,),
}
MEASURE_LABELS = {
    "exact": "exact match",
    "equivalent": "equivalence",
    "same_plan": "same plan",
    "all": "all three",
    "well_formed": "well-formed",
}


@dataclass(frozen=True, slots=True)
class Link:
    """One choice of a switch; ``query`` is the address that makes it and keeps all others."""

    label: str
    query: str
    is_current: bool


@dataclass(frozen=True, slots=True)
class ResultsChoices:
    """``measure`` is a key of ``MEASURES``; ``published`` says whether the paper's figures stand beside ours."""

    part: str
    splits: tuple[Split, ...]
    measure: str = "exact"
    published: bool = False

    @property
    def measures(self) -> tuple[Measure, ...]:
        return MEASURES[self.measure]

    @property
    def measures_in_words(self) -> str:
        """The measures, each with its sign where there are several: ``exact match (✓) and same plan (→)``."""
        if len(self.measures) == 1:
            return self.measures[0].in_words
        *others, last = (f"{each.in_words} ({each.sign})" for each in self.measures)
        return f"{', '.join(others)} and {last}"

    @property
    def query(self) -> str:
        """The address that makes these choices."""
        chosen = [("part", self.part), *(("split", split.name) for split in self.splits)]
        if self.measure != "exact":
            chosen.append(("measure", self.measure))
        if self.published:
            chosen.append(("published", "yes"))
        return urlencode(chosen)

    def tables(self, world: World) -> list[AccuracyTable]:
        """Return the accuracy tables that these choices show."""
        return accuracy_tables(world, self.part, self.splits, self.measures, self.published)

    @property
    def part_links(self) -> list[Link]:
        return self._links("part", [(part, str(part)) for part in PARTS])

    @property
    def measure_links(self) -> list[Link]:
        return self._links("measure", list(MEASURE_LABELS.items()))

    @property
    def published_links(self) -> list[Link]:
        return self._links("published", [(False, "ours"), (True, "beside published")])

    def _links(self, name: str, options: Sequence[tuple[Any, str]]) -> list[Link]:
        return [
            Link(label, replace(self, **{name: value}).query, getattr(self, name) == value)
            for value, label in options
        ]


def scored_splits(world: World) -> list[Split]:
    """Return the splits that somebody trained on, newest first."""
    return list(world.splits.filter(runs__isnull=False).distinct())


def read_choices(query: QueryDict, world: World, splits: Sequence[Split]) -> ResultsChoices:
    """Read the choices from an address. What it leaves out or misspells is the default: the newest
    ``splits``, and the test part where something was scored on it."""
    names = query.getlist("split")
    chosen = [split for split in splits if split.name in names] or splits[:MOST_SPLITS]
    part = query.get("part", "")
    measure = query.get("measure", "")
    return ResultsChoices(
        part=part if part in PARTS else default_part(world, splits=chosen),
        splits=tuple(chosen),
        measure=measure if measure in MEASURES else "exact",
        published=query.get("published") == "yes",
    )


def default_part(
    world: World, keys: Sequence[int] = (), splits: Sequence[Split] | None = None
) -> str:
    """Return the test part, unless nothing has been scored on one, or on one of ``splits``; of the runs with
    ``keys``, unless one of them has not."""
    runs = world.runs.all() if splits is None else world.runs.filter(split__in=splits)
    if keys:
        is_tested = not runs.filter(pk__in=keys).exclude(evaluations__part=Part.TEST).exists()
    else:
        is_tested = runs.filter(evaluations__part=Part.TEST).exists()
    return Part.TEST if is_tested else Part.VALIDATION
