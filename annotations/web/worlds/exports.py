"""Everything that a world gives away as a file: what it is for, and where it is fetched. The one list of it."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from django.urls import reverse
from django.utils.http import urlencode

from annotations.exchange.generator_export import GeneratorPart
from annotations.exchange.rephrased_export import RephrasedFormat
from annotations.exchange.split_export import SplitFormat
from annotations.exchange.tables import TableFormat
from annotations.exchange.vocabulary_export import VocabularyFormat, VocabularyPart
from annotations.models import (
    Duty,
    Entity,
    Paraphrase,
    Predicate,
    Production,
    SemanticTemplate,
    Submission,
    Utterance,
    World,
)
from annotations.models.description import TemplateStatus

MOST_SPLITS = 8


@dataclass(frozen=True, slots=True)
class ExportLink:
    """A file, or the page that has it."""

    label: str
    url: str
    is_file: bool = True


@dataclass(frozen=True, slots=True)
class Export:
    """Something that is exported. ``purpose`` says in one sentence what it is for."""

    title: str
    purpose: str
    links: tuple[ExportLink, ...]


def exports_of(world: World, duties: Collection[Duty]) -> list[Export]:
    """List what the world has to give to somebody with ``duties``; what there are no rows for is left out."""
    listed = (
        Export(
            "The whole world",
            "One archive, to keep or to make the same world in another installation. Accounts and runs stay here.",
            (ExportLink("Archive (zip)", _address(world, "download")),),
        ),
        Export(
            "Files of the generator",
            "What a command generator reads, and an import here too. Drafts are left out.",
            tuple(_generator_links(world)),
        ),
        Export(
            "Vocabulary",
            "Names and words of the grammar as hot words, so that a speech recogniser hears them.",
            tuple(_vocabulary_links(world)),
        ),
        Export(
            "Utterances",
            "What people said with its labels, who gave them and when, for other programs.",
            tuple(_utterance_links(world)),
        ),
        Export(
            "Rephrased data",
            "Accepted paraphrases with their plans, to tune or to test a language model.",
            tuple(_rephrased_links(world)),
        ),
        Export(
            "Submissions to campaigns",
            "All answers by pseudonym, to pay people or to study how they work.",
            tuple(_submission_links(world)) if Duty.REVIEW in duties else (),
        ),
        Export(
            "Splits",
            "Training, validation and test parts, to train elsewhere. The page of a split has the files of one part.",
            tuple(_split_links(world)),
        ),
        Export(
            "Reports",
            "One HTML file about a run or a comparison that opens offline, for a paper or a mail.",
            tuple(_report_links(world)),
        ),
    )
    return [each for each in listed if each.links]


def _address(world: World, name: str, query: Mapping[str, Any] | None = None, **key: Any) -> str:
    address = reverse(name, kwargs={"world": world.name, **key})
    return f"{address}?{urlencode(query)}" if query else address


def _by_format(
    world: World, name: str, labels: Iterable[tuple[StrEnum, str]]
) -> Iterable[ExportLink]:
    """Yield a link to what the route ``name`` answers in each format, which has a label."""
    for format, label in labels:
        yield ExportLink(label, _address(world, name, {"as": format.value}))


def _generator_links(world: World) -> Iterable[ExportLink]:
    ready = SemanticTemplate.objects.filter(grammar__world=world, status=TemplateStatus.READY)
    rows = {
        GeneratorPart.ONTOLOGY: Entity.objects.filter(ontology__world=world),
        GeneratorPart.GRAMMAR: Production.objects.filter(grammar__world=world),
        GeneratorPart.TEMPLATES: ready,
        GeneratorPart.PREDICATES: Predicate.objects.filter(world=world),
    }
    for part, some in rows.items():
        if some.exists():
            yield ExportLink(part.label, _address(world, "download_part", part=part.value))


def _vocabulary_links(world: World) -> Iterable[ExportLink]:
    if not Entity.objects.filter(ontology__world=world).exists():
        return
    names = {"as": VocabularyFormat.TXT.value, "only": VocabularyPart.NAMES.value}
    yield ExportLink("Names, one a line", _address(world, "api:vocabulary", names))
    labels = {
        VocabularyFormat.TXT: "With words of the grammar",
        VocabularyFormat.JSONL: "JSON Lines, with classes",
        VocabularyFormat.VOSK: "Vosk",
    }
    yield from _by_format(world, "api:vocabulary", labels.items())


def _utterance_links(world: World) -> Iterable[ExportLink]:
    if Utterance.objects.filter(world=world).exists():
        labels = {
            TableFormat.JSONL: "JSON Lines",
            TableFormat.CSV: "CSV",
            TableFormat.PARQUET: "Parquet",
        }
        yield from _by_format(world, "api:utterance-export", labels.items())


def _rephrased_links(world: World) -> Iterable[ExportLink]:
    if Paraphrase.objects.filter(world=world).accepted().exists():
        labels = {
            RephrasedFormat.CHAT: "Chat messages",
            RephrasedFormat.PAIRS: "Pairs",
            RephrasedFormat.TESTS: "Test cases",
        }
        yield from _by_format(world, "api:paraphrase-export", labels.items())


def _submission_links(world: World) -> Iterable[ExportLink]:
    if Submission.objects.filter(contributor__campaign__world=world).exists():
        yield ExportLink("CSV", _address(world, "api:submission-export"))


def _split_links(world: World) -> Iterable[ExportLink]:
    splits = list(world.splits.order_by("-pk")[: MOST_SPLITS + 1])
    for split in splits[:MOST_SPLITS]:
        query = {"as": SplitFormat.ZIP.value}
        url = _address(world, "api:split-export", query, pk=split.pk)
        yield ExportLink(f"{split.name} (zip)", url)
    if splits:
        yield ExportLink("All splits", _address(world, "splits"), is_file=False)


def _report_links(world: World) -> Iterable[ExportLink]:
    """Yield the pages that have a button “Report”."""
    if world.splits.exists():  # without one there is no run
        yield ExportLink("Runs", _address(world, "runs"), is_file=False)
        yield ExportLink("Compare", _address(world, "compare"), is_file=False)
