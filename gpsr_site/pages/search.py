"""Search a whole world by kind: what any of its lists would show for the same words."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode

from django.db.models import Model
from django.http import HttpRequest, HttpResponse
from django.shortcuts import render
from django.urls import reverse

from annotations.models import (
    Command,
    Duty,
    Entity,
    LogicalForm,
    Paraphrase,
    Predicate,
    Production,
    SemanticTemplate,
    Split,
    Utterance,
    World,
)
from annotations.people.access import world_view
from annotations.showing.filtering import PageFilters
from annotations.showing.form_presentation import shown
from annotations.web.corpus.corpus_filters import (
    CommandFilters,
    LogicalFormFilters,
    ParaphraseFilters,
    UtteranceFilters,
)
from annotations.web.corpus.split_filters import SplitFilters
from annotations.web.description.description_filters import (
    EntityFilters,
    PredicateFilters,
    ProductionFilters,
    TemplateFilters,
)
from parser_service.models import TrainingRun
from parser_service.parsers.registry import title_of
from parser_service.web.runs.run_filters import RunFilters

MOST_SHOWN = 5  # rows of each kind
MOST_COUNTED = 1_000  # beyond it the page says "over 1,000"


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of rows that can be searched.

    ``list_name`` and ``page_name`` are the URL names of its list and of the page of one row.
    ``world_path`` leads from a row to its world.
    """

    title: str
    model: type[Model]
    filters: type[PageFilters]
    list_name: str
    page_name: str
    text: Callable[[Any], str]
    note: Callable[[Any], str] = lambda row: ""
    world_path: str = "world"


KINDS = (
    Kind(
        "Entities",
        Entity,
        EntityFilters,
        "ontology",
        "entity",
        lambda row: row.text,
        lambda row: row.entity_class,
        "ontology__world",
    ),
    Kind(
        "Predicates",
        Predicate,
        PredicateFilters,
        "predicates",
        "predicate",
        lambda row: row.name,
        lambda row: row.gloss,
    ),
    Kind(
        "Productions",
        Production,
        ProductionFilters,
        "grammar",
        "production",
        lambda row: f"${row.nonterminal} = {row.expansion}",
        lambda row: row.source,
        "grammar__world",
    ),
    Kind(
        "Templates",
        SemanticTemplate,
        TemplateFilters,
        "templates",
        "template",
        lambda row: row.pattern,
        lambda row: shown(row.form).reading,
        "grammar__world",
    ),
    Kind(
        "Commands", Command, CommandFilters, "commands", "command", lambda row: row.anonymized_text
    ),
    Kind(
        "Logical forms",
        LogicalForm,
        LogicalFormFilters,
        "logical_forms",
        "logical_form",
        lambda row: shown(row.text).reading,
    ),
    Kind(
        "Paraphrases",
        Paraphrase,
        ParaphraseFilters,
        "paraphrases",
        "paraphrase",
        lambda row: row.utterance,
        lambda row: row.prompt,
    ),
    Kind(
        "Utterances",
        Utterance,
        UtteranceFilters,
        "utterances",
        "utterance",
        lambda row: row.text,
        lambda row: row.status,
    ),
    Kind("Splits", Split, SplitFilters, "splits", "split", lambda row: row.name),
    Kind(
        "Runs",
        TrainingRun,
        RunFilters,
        "runs",
        "run",
        lambda row: f"run {row.pk}",
        lambda row: f"{title_of(row.parser)}, {row.status}",
    ),
)


@dataclass(frozen=True, slots=True)
class Hit:
    """A row that matches: its text, a few words about it, and where it is shown."""

    text: str
    note: str
    url: str


@dataclass(frozen=True, slots=True)
class Group:
    """The matches of one kind: the first few, how many there are, and the list of all of them."""

    title: str
    hits: tuple[Hit, ...]
    count: int
    url: str

    @property
    def is_cut(self) -> bool:
        """Whether there are more matches than ``count``."""
        return self.count > MOST_COUNTED


@world_view(Duty.VIEW)
def search(request: HttpRequest, world: World) -> HttpResponse:
    """Show what the world has for the words in ``q``, by kind."""
    words = request.GET.get("q", "").replace("\0", "").strip()
    groups = list(groups_of(request, world, words)) if words else []
    return render(
        request, "gpsr_site/search.html", {"words": words, "groups": groups, "kinds": KINDS}
    )


def groups_of(request: HttpRequest, world: World, words: str) -> Iterator[Group]:
    """Yield the kinds that have matches, in the order of the flow."""
    for kind in KINDS:
        rows = kind.model._default_manager.filter(**{kind.world_path: world})
        matches = kind.filters({"q": words}, queryset=rows, request=request).qs
        count = matches.order_by()[: MOST_COUNTED + 1].count()
        if not count:
            continue
        hits = tuple(
            Hit(
                kind.text(row),
                kind.note(row),
                reverse(kind.page_name, kwargs={"world": world.name, "pk": row.pk}),
            )
            for row in matches[:MOST_SHOWN]
        )
        list_url = reverse(kind.list_name, kwargs={"world": world.name})
        yield Group(kind.title, hits, count, f"{list_url}?{urlencode({'q': words})}")
