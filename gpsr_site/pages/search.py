"""Search a whole world by kind: what any of its lists would show for the same words, and pages, worlds and documents.

While somebody types the top bar asks for the first few: it looks through the newest rows of each kind alone, so that an
answer costs the same in every world.
"""

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
from annotations.people.access import WorldRequest, world_view
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
from gpsr_site.documents import Hit as DocumentHit
from gpsr_site.documents import search_documents
from gpsr_site.pages.rail import all_entries
from parser_service.models import TrainingRun
from parser_service.parsers.registry import title_of
from parser_service.web.runs.run_filters import RunFilters

MOST_SHOWN = 5  # rows of each kind
MOST_COUNTED = 1_000  # beyond it the page says "over 1,000"
MOST_SCANNED = 5_000  # rows of each kind, while somebody types
MOST_WHILE_TYPING = 2  # rows of each kind
OWN_PAGES = (
    ("Worlds", "home"),
    ("Documents", "documents"),
    ("Inbox", "inbox"),
    ("My drafts", "my_drafts"),
    ("Account", "account"),
)


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
    """The matches of one kind: the first few, how many there are, and the list of all of them, where there is one."""

    title: str
    hits: tuple[Hit, ...]
    count: int
    url: str

    @property
    def is_cut(self) -> bool:
        """Whether there are more matches than ``count``."""
        return self.count > MOST_COUNTED


@world_view(Duty.VIEW)
def search(request: WorldRequest, world: World) -> HttpResponse:
    """Show what the world has for the words in ``q``, by kind."""
    words = _words_in(request)
    context = {
        "words": words,
        "leads": leads_of(request, world, words),
        "groups": list(groups_of(request, world, words)) if words else [],
        "kinds": KINDS,
    }
    return render(request, "gpsr_site/search.html", context)


@world_view(Duty.VIEW)
def search_found(request: WorldRequest, world: World) -> HttpResponse:
    """Return the first matches for the words in ``q``, as the top bar lists them while somebody types."""
    words = _words_in(request)
    groups = leads_of(request, world, words)
    if words:
        groups += newest_of(request, world, words)
    context = {"words": words, "groups": groups, "rail_world": world}
    return render(request, "_search_found.html", context)


def _words_in(request: HttpRequest) -> str:
    return request.GET.get("q", "").replace("\0", "").strip()


def leads_of(request: WorldRequest, world: World, words: str) -> list[Group]:
    """Return the pages, worlds and documents whose names have the words; of documents also what they say."""
    wanted = words.casefold().split()
    if not wanted:
        return []
    pages = [
        *(
            Hit(entry.label, "", reverse(entry.page, kwargs={"world": world.name}) + entry.query)
            for entry in all_entries()
            if entry.duty in request.duties and entry.has_page
        ),
        *(Hit(label, "", reverse(name)) for label, name in OWN_PAGES),
    ]
    worlds = World.objects.visible_to(request.user).filter(name__icontains=words)
    groups = (
        ("Pages", [page for page in pages if _begins(page.text, wanted)]),
        (
            "Worlds",
            [
                Hit(each.name, "", reverse("world", args=[each.name]))
                for each in worlds[:MOST_SHOWN]
            ],
        ),
        ("Documents", [_document_hit(hit) for hit in search_documents(words)]),
    )
    return [Group(title, tuple(hits[:MOST_SHOWN]), len(hits), "") for title, hits in groups if hits]


def _begins(label: str, wanted: list[str]) -> bool:
    """Whether each of the words is the beginning of a word of ``label``."""
    heads = label.casefold().split()
    return all(any(head.startswith(word) for head in heads) for word in wanted)


def _document_hit(hit: DocumentHit) -> Hit:
    heading = hit.heading.text if hit.heading.level > 1 else ""
    return Hit(hit.document.title, heading, hit.url)


def newest_of(request: HttpRequest, world: World, words: str) -> list[Group]:
    """Return the first matches of each kind among the newest ``MOST_SCANNED`` rows of the world."""
    groups = []
    for kind in KINDS:
        rows = kind.model._default_manager.filter(**{kind.world_path: world})
        newest = rows.order_by("-pk").values("pk")[:MOST_SCANNED]
        scanned = kind.model._default_manager.filter(pk__in=newest)
        matches = kind.filters({"q": words}, queryset=scanned, request=request).qs
        if hits := tuple(
            _hit(kind, row, world) for row in matches.order_by("-pk")[:MOST_WHILE_TYPING]
        ):
            groups.append(Group(kind.title, hits, len(hits), ""))
    return groups


def _hit(kind: Kind, row: Model, world: World) -> Hit:
    address = reverse(kind.page_name, kwargs={"world": world.name, "pk": row.pk})
    return Hit(kind.text(row), kind.note(row), address)


def groups_of(request: HttpRequest, world: World, words: str) -> Iterator[Group]:
    """Yield the kinds that have matches, in the order of the flow."""
    for kind in KINDS:
        rows = kind.model._default_manager.filter(**{kind.world_path: world})
        matches = kind.filters({"q": words}, queryset=rows, request=request).qs
        count = matches.order_by()[: MOST_COUNTED + 1].count()
        if not count:
            continue
        hits = tuple(_hit(kind, row, world) for row in matches[:MOST_SHOWN])
        list_url = reverse(kind.list_name, kwargs={"world": world.name})
        yield Group(kind.title, hits, count, f"{list_url}?{urlencode({'q': words})}")
