"""What every page shows around its content: the rail of its world and the state of the workers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from django.conf import settings
from django.http import HttpRequest
from django.urls import ResolverMatch, reverse
from django.utils.functional import SimpleLazyObject

from annotations.language.english import say_count
from annotations.models import Duty, Notice, World
from annotations.rows.kinds import KINDS
from gpsr_site.overview.counts import Counts, counts_of
from gpsr_site.overview.workers import workers_now


@dataclass(frozen=True, slots=True)
class Place:
    """A page of the rail: ``count`` and ``waiting`` are fields of ``Counts``.

    Where ``waiting`` is not 0 the entry gets a dot, explained as ``3 templates not ready``: the count
    with its ``noun``, then the ``reason``. ``below`` are the further URL names that belong to it.
    """

    label: str
    name: str
    count: str = ""
    waiting: str = ""
    noun: str = ""
    reason: str = ""
    below: tuple[str, ...] = ()

    def dot(self, counts: Counts) -> str:
        """Say what waits here; empty for nothing."""
        waiting = getattr(counts, self.waiting) if self.waiting else 0
        if not waiting:
            return ""
        return f"{say_count(waiting, self.noun)} {self.reason}" if self.noun else self.reason


# In the order of the flow.
PLACES = (
    Place(
        "Overview",
        "world",
        below=("import", "import_pairs", "jobs", "job", "people", "audit_log", "world_delete"),
    ),
    Place(
        "Ontology",
        "ontology",
        "entities",
        "ontology_problems",
        "remark",
        "to read",
        below=(
            *("entity", "entity_new", "entities_new", "offered_entities"),
            *("predicates", "predicate", "predicate_new", "robot"),
        ),
    ),
    Place(
        "Grammar",
        "grammar",
        "productions",
        "grammar_problems",
        "remark",
        "to read",
        below=(
            *("production", "production_new"),
            *("uncovered", "unmatched", "conflicts", "outside_grammar"),
        ),
    ),
    Place(
        "Templates",
        "templates",
        "templates",
        "templates_waiting",
        "template",
        "not ready",
        below=("template", "template_new"),
    ),
    Place(
        "Commands",
        "commands",
        "commands",
        "stale",
        "",
        "out of date",
        below=("command", "logical_forms", "logical_form", "complexity"),
    ),
    Place(
        "Paraphrases",
        "paraphrases",
        "paraphrases",
        "paraphrases_waiting",
        "paraphrase",
        "to judge",
        below=("paraphrase",),
    ),
    Place(
        "Utterances",
        "utterances",
        "utterances",
        "utterances_waiting",
        "utterance",
        "without a form",
        below=("utterance", "utterances_new", "label"),
    ),
    Place(
        "Queue",
        "queue",
        "work_items",
        "work_items_free",
        "item",
        "to do",
        below=("queue_item", "queue_settings", "audit", "agreement", "progress"),
    ),
    Place("Splits", "splits", "splits", below=("split", "split_new", "example")),
    Place(
        "Runs",
        "runs",
        "runs",
        "runs_active",
        "run",
        "queued or running",
        below=("run", "run_new"),
    ),
    Place(
        "Results",
        "results",
        "evaluated",
        below=(
            "predictions",
            "learning_curves",
            "defaults",
            "sensitivity",
            "probes",
            "tryout",
        ),
    ),
    Place("Compare", "compare", below=("slices",)),
    Place("Errors", "review", below=("error_categories", "error_category")),
    Place(
        "Parse",
        "playground",
        waiting="promotions_proposed",
        noun="run",
        reason="proposed for promotion",
        below=("promotions", "dialogues", "dialogue"),
    ),
)


# Kind of row → the route of the list that holds it.
LISTS = {kind.name: kind.list_page for kind in KINDS.values()}
LISTS |= {"form": "logical_forms"}


@dataclass(frozen=True, slots=True)
class Entry:
    """A ``Place`` as the rail draws it; ``dot`` says what waits there."""

    label: str
    url: str
    count: int | None
    dot: str
    is_current: bool


def frame(request: HttpRequest) -> dict[str, Any]:
    """Return the context of every page. What costs a query is looked up where a template reads it, once."""
    world: World | None = getattr(request, "world", None)
    duties = getattr(request, "duties", frozenset())
    return {
        "world": world,
        "sso": settings.SSO_NAME,
        "can": {duty.value: duty in duties for duty in Duty},
        "worlds": World.objects.visible_to(request.user),
        "rail": SimpleLazyObject(lambda: list(_rail(request, world))) if world else [],
        "worker": SimpleLazyObject(workers_now),
        "unread": SimpleLazyObject(lambda: Notice.objects.of(request.user).unread().count()),
    }


def _rail(request: HttpRequest, world: World) -> Iterator[Entry]:
    counts = getattr(request, "counts", None) or counts_of(world)
    for place in PLACES:
        yield _entry(place, world, counts, _current(request.resolver_match))


def _current(match: ResolverMatch | None) -> str:
    """Return the route that the rail marks; a page about any kind of row belongs to the list of that kind."""
    if match is None:
        return ""
    return LISTS.get(match.kwargs.get("kind", ""), match.url_name or "")


def _entry(place: Place, world: World, counts: Counts, current: str) -> Entry:
    return Entry(
        label=place.label,
        url=reverse(place.name, kwargs={"world": world.name}),
        count=getattr(counts, place.count) if place.count else None,
        dot=place.dot(counts),
        is_current=current == place.name or current in place.below,
    )
