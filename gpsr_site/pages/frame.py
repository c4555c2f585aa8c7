"""What every page shows around its content: the rail of its world and the state of the workers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote

from django.conf import settings
from django.http import HttpRequest
from django.urls import reverse
from django.utils.functional import SimpleLazyObject

from annotations.language.english import say_count
from annotations.models import Duty, Notice, World
from annotations.rows.row_kinds import KINDS
from gpsr_site.overview.counts import Counts, counts_of
from gpsr_site.overview.workers import workers_now

CLOSED_NOTICE = "closed_notice"  # the cookie that names the notice which the reader has closed


@dataclass(frozen=True, slots=True, kw_only=True)
class Waiting:
    """What the dot of an entry says, such as ``3 templates not ready``: a count, its noun, a reason.

    ``count`` is a field of ``Counts``; 0 of it is no dot. Without a noun the reason stands alone.
    """

    count: str
    noun: str = ""
    reason: str

    def sentence(self, counts: Counts) -> str:
        """Say what waits; empty for nothing."""
        number = getattr(counts, self.count)
        if not number:
            return ""
        return f"{say_count(number, self.noun)} {self.reason}" if self.noun else self.reason


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """An entry of the rail. It leads to ``page`` and is marked there and on all ``pages_below``: URL names.

    ``count`` is a field of ``Counts`` that stands beside the label.
    """

    label: str
    page: str
    count: str = ""
    waiting: Waiting | None = None
    pages_below: tuple[str, ...] = ()


# In the order of the flow.
PLACES = (
    Place(
        label="Overview",
        page="world",
        pages_below=(
            *("import", "import_competition", "import_pairs", "jobs", "job"),
            *("people", "audit_log", "world_delete"),
        ),
    ),
    Place(
        label="Ontology",
        page="ontology",
        count="entities",
        waiting=Waiting(count="ontology_problems", noun="remark", reason="to read"),
        pages_below=(
            *("entity", "entity_new", "entities_new", "location_rooms", "offered_entities"),
            *("entity_classes", "entity_class", "entity_class_new"),
            *("predicates", "predicate", "predicate_new", "robot"),
        ),
    ),
    Place(
        label="Grammar",
        page="grammar",
        count="productions",
        waiting=Waiting(count="grammar_problems", noun="remark", reason="to read"),
        pages_below=(
            *("production", "production_new"),
            *("uncovered", "unmatched", "conflicts", "outside_grammar"),
        ),
    ),
    Place(
        label="Templates",
        page="templates",
        count="templates",
        waiting=Waiting(count="templates_waiting", noun="template", reason="not ready"),
        pages_below=("template", "template_new"),
    ),
    Place(
        label="Commands",
        page="commands",
        count="commands",
        waiting=Waiting(count="stale", reason="out of date"),
        pages_below=("command", "logical_forms", "logical_form", "complexity", "generation"),
    ),
    Place(
        label="Paraphrases",
        page="paraphrases",
        count="paraphrases",
        waiting=Waiting(count="paraphrases_waiting", noun="paraphrase", reason="to judge"),
        pages_below=(
            *("paraphrase", "submissions", "submission"),
            *("paraphrase_figures", "paraphrase_forms", "paraphrase_contributors"),
            *("campaigns", "campaign_new", "campaign_page", "campaign_edit", "campaign_results"),
            *("campaign_model", "contributor_forget"),
        ),
    ),
    Place(
        label="Utterances",
        page="utterances",
        count="utterances",
        waiting=Waiting(count="utterances_waiting", noun="utterance", reason="without a form"),
        pages_below=("utterance", "utterances_new", "label", "uploads", "upload"),
    ),
    Place(
        label="Queue",
        page="queue",
        count="work_items",
        waiting=Waiting(count="work_items_free", noun="item", reason="to do"),
        pages_below=(
            *("queue_item", "queue_settings", "guidelines"),
            *("audit", "agreement", "progress"),
        ),
    ),
    Place(
        label="Splits", page="splits", count="splits", pages_below=("split", "split_new", "example")
    ),
    Place(
        label="Runs",
        page="runs",
        count="runs",
        waiting=Waiting(count="runs_active", noun="run", reason="queued or running"),
        pages_below=("run", "run_new"),
    ),
    Place(
        label="Results",
        page="results",
        count="evaluated",
        pages_below=(
            *("predictions", "learning_curves", "defaults"),
            *("sensitivity", "probes", "tryout"),
        ),
    ),
    Place(label="Compare", page="compare", pages_below=("slices",)),
    Place(label="Review", page="review", pages_below=("error_categories", "error_category")),
    Place(
        label="Parse",
        page="playground",
        waiting=Waiting(count="promotions_proposed", noun="run", reason="proposed for promotion"),
        pages_below=("promotions", "dialogues", "dialogue", "joint_plan"),
    ),
    Place(
        label="Recipes",
        page="recipes",
        pages_below=("recipe", "recipe_new", "primitive", "primitive_new"),
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
    duties: frozenset[Duty] = getattr(request, "duties", frozenset())
    user = request.user
    return {
        "world": world,
        "sso": settings.SSO_NAME,
        "can": {duty.value: duty in duties for duty in Duty},
        "worlds": World.objects.visible_to(user),
        "rail": SimpleLazyObject(lambda: list(_rail(request, world))) if world else [],
        "worker": SimpleLazyObject(workers_now),
        "closed_notice": unquote(request.COOKIES.get(CLOSED_NOTICE, "")),
        "unread": SimpleLazyObject(
            lambda: Notice.objects.of(user).unread().count() if user.is_authenticated else 0
        ),
    }


def _rail(request: HttpRequest, world: World) -> Iterator[Entry]:
    counts = getattr(request, "counts", None) or counts_of(world)
    match, current = request.resolver_match, ""
    if match is not None:  # a page about any kind of row belongs to the list of that kind
        current = LISTS.get(match.kwargs.get("kind", ""), match.url_name or "")
    for place in PLACES:
        yield Entry(
            label=place.label,
            url=reverse(place.page, kwargs={"world": world.name}),
            count=getattr(counts, place.count) if place.count else None,
            dot=place.waiting.sentence(counts) if place.waiting else "",
            is_current=current in (place.page, *place.pages_below),
        )
