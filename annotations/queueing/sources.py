"""Verb: fill the queue with what the rows of a world call for."""

from __future__ import annotations

from collections.abc import Iterator

from django.db.models import Exists, OuterRef

from annotations.models import SemanticTemplate, Utterance, WorkItem, World
from annotations.models.corpus import UtteranceStatus
from annotations.models.description import TemplateStatus
from annotations.models.queueing import WorkKind
from annotations.queueing.enqueuing import WantedItem, enqueue

MOST_AT_ONCE = 1000  # of each kind, so that nobody waits long for it


def refill(world: World) -> int:
    """Add items for utterances without a form and for what is disputed. Return how many are new.

    What has an open item of any kind gets no other one.
    """
    return (
        enqueue(world, WorkKind.UNLABELLED, _unlabelled_utterances(world))
        + enqueue(world, WorkKind.DISPUTED, _disputed_utterances(world))
        + enqueue(world, WorkKind.DISPUTED, _disputed_templates(world))
    )


def _unlabelled_utterances(world: World) -> Iterator[WantedItem]:
    for row in _without_item(world, UtteranceStatus.UNLABELLED):
        yield WantedItem(row, "Nobody has said yet what this means.")


def _disputed_utterances(world: World) -> Iterator[WantedItem]:
    for row in _without_item(world, UtteranceStatus.DISPUTED):
        label = row.accepted_label
        who = (label and label.annotator) or "Somebody"
        reason = (label and label.reason) or "no reason was given"
        yield WantedItem(row, f"{who} disputes it: {reason}")


def _without_item(world: World, status: str) -> list[Utterance]:
    items = WorkItem.objects.open().filter(utterance=OuterRef("pk"))
    rows = world.utterances.filter(~Exists(items), status=status)
    return list(rows.order_by("pk")[:MOST_AT_ONCE])


def _disputed_templates(world: World) -> Iterator[WantedItem]:
    items = WorkItem.objects.open().filter(template=OuterRef("pk"))
    rows = SemanticTemplate.objects.filter(
        ~Exists(items), grammar__world=world, status=TemplateStatus.DISPUTED
    )
    for row in rows.order_by("pk")[:MOST_AT_ONCE]:
        yield WantedItem(row, "This template is disputed and makes no commands.")
