"""Verb: put items into the queue of a world."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from django.db import transaction

from annotations.models import Paraphrase, SemanticTemplate, User, Utterance, WorkItem, World
from annotations.models.queueing import DRAWS, LONGEST_REASON, LONGEST_TITLE, PRIORITIES, WorkKind
from annotations.queueing.shares import DOUBLE_KINDS, people_for, shares_of
from annotations.rows.synchronise import batches

BATCH = 500

Subject = Utterance | SemanticTemplate | Paraphrase


@dataclass(frozen=True, slots=True)
class WantedItem:
    """What somebody is to look at, and the sentence that says why."""

    subject: Subject
    reason: str


def enqueue(
    world: World, kind: WorkKind, wanted: Iterable[WantedItem], by: User | None = None
) -> int:
    """Add an item of ``kind`` for each subject that has no open one of it. Return how many are new.

    Nobody is asked twice what an utterance means: an item that nobody has touched yet makes room for a
    more urgent one, and any other one keeps a new one out.

    Args:
        by: who asks for it; None for a machine.
    """
    newest = world.work_items.order_by("-pk").values_list("pk", flat=True).first() or 0
    shares = shares_of(world)
    for some in batches(wanted, BATCH):
        with transaction.atomic():
            asked = _find_asked(WorkKind(kind), some) if kind in DOUBLE_KINDS else set()
            rows = [
                _make_item(world, WorkKind(kind), each, by, shares)
                for each in some
                if not (isinstance(each.subject, Utterance) and each.subject.pk in asked)
            ]
            WorkItem.objects.bulk_create(rows, ignore_conflicts=True)
    return world.work_items.filter(pk__gt=newest, kind=kind).count()


def _find_asked(kind: WorkKind, wanted: Sequence[WantedItem]) -> set[int]:
    """Return the utterances about which people are asked; less urgent untouched items are removed first."""
    keys = [each.subject.pk for each in wanted if isinstance(each.subject, Utterance)]
    rows = WorkItem.objects.open().filter(utterance__in=keys, kind__in=DOUBLE_KINDS)
    less_urgent = rows.untouched().filter(priority__lt=PRIORITIES[kind])
    WorkItem.objects.filter(pk__in=[row.pk for row in less_urgent.select_for_update()]).delete()
    return set(rows.values_list("utterance_id", flat=True))


def _make_item(
    world: World, kind: WorkKind, wanted: WantedItem, by: User | None, shares: dict[str, int]
) -> WorkItem:
    name = field_of(wanted.subject)
    draw = draw_of(kind, name, wanted.subject.pk)
    people = people_for(kind, name, draw, shares)
    return WorkItem(
        world=world,
        kind=kind,
        reason=wanted.reason[:LONGEST_REASON],
        title=title_of(wanted.subject)[:LONGEST_TITLE],
        priority=PRIORITIES[kind],
        people=people,
        places=people,
        draw=draw,
        created_by=by,
        **{name: wanted.subject},
    )


def field_of(subject: Subject) -> str:
    """Return the field of ``WorkItem`` that holds ``subject``."""
    return {Utterance: "utterance", SemanticTemplate: "template", Paraphrase: "paraphrase"}[
        type(subject)
    ]


def title_of(subject: Subject) -> str:
    if isinstance(subject, SemanticTemplate):
        return subject.pattern
    return subject.text if isinstance(subject, Utterance) else subject.utterance


def draw_of(kind: str, name: str, key: int) -> int:
    """Return a number below ``DRAWS`` that looks random and is the same each time."""
    digest = hashlib.sha256(f"{kind}:{name}:{key}".encode()).digest()
    return int.from_bytes(digest[:4]) % DRAWS
