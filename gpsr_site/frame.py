"""What every page shows around its content: the rail of its world and the state of the workers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from django.http import HttpRequest
from django.urls import reverse
from django.utils.functional import SimpleLazyObject

from annotations.models import Duty, World
from gpsr_site.counts import Counts, counts_of
from gpsr_site.workers import workers_now


@dataclass(frozen=True, slots=True)
class Place:
    """A page of the rail: ``count`` and ``waiting`` are fields of ``Counts``.

    Where ``waiting`` is not 0 the entry gets a dot, which ``reason`` explains. ``below`` are the
    further URL names that belong to it.
    """

    label: str
    name: str
    count: str = ""
    waiting: str = ""
    reason: str = ""
    below: tuple[str, ...] = ()


# In the order of the flow.
PLACES = (
    Place("Overview", "world", below=("import", "import_pairs")),
    Place(
        "World",
        "ontology",
        "entities",
        "ontology_problems",
        "{n} remarks to read",
        below=("predicates",),
    ),
    Place("Grammar", "grammar", "productions", "grammar_problems", "{n} remarks to read"),
    Place(
        "Templates",
        "templates",
        "templates",
        "templates_waiting",
        "{n} not ready",
        below=("template", "template_new"),
    ),
    Place("Commands", "commands", "commands", below=("forms", "form", "complexity")),
    Place("Paraphrases", "paraphrases", "paraphrases", "paraphrases_waiting", "{n} to judge"),
    Place("Splits", "splits", "splits", below=("split", "split_new")),
    Place("Runs", "runs", "runs", "runs_active", "{n} queued or running", below=("run", "run_new")),
    Place("Results", "results", "evaluated", below=("predictions", "prediction")),
)


@dataclass(frozen=True, slots=True)
class Entry:
    """A ``Place`` as the rail draws it; ``dot`` says what waits there."""

    label: str
    url: str
    count: int | None
    dot: str
    is_current: bool


def frame(request: HttpRequest) -> dict[str, Any]:
    """The context of every page. What costs a query is looked up where a template reads it, once."""
    world: World | None = getattr(request, "world", None)
    duties = getattr(request, "duties", frozenset())
    return {
        "world": world,
        "can": {duty.value: duty in duties for duty in Duty},
        "worlds": World.objects.visible_to(request.user),
        "rail": SimpleLazyObject(lambda: list(_rail(request, world))) if world else [],
        "worker": SimpleLazyObject(workers_now),
    }


def _rail(request: HttpRequest, world: World) -> Iterator[Entry]:
    match = request.resolver_match
    counts = counts_of(world)
    for place in PLACES:
        yield _entry(place, world, counts, (match and match.url_name) or "")


def _entry(place: Place, world: World, counts: Counts, current: str) -> Entry:
    waiting = getattr(counts, place.waiting) if place.waiting else 0
    return Entry(
        label=place.label,
        url=reverse(place.name, kwargs={"world": world.name}),
        count=getattr(counts, place.count) if place.count else None,
        dot=place.reason.format(n=waiting) if waiting else "",
        is_current=current == place.name or current in place.below,
    )
