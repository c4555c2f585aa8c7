"""Verbs: put items into the queue of a world, fill it with what its rows call for, and say what share two people do."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from django.db import transaction
from django.db.models import Exists, OuterRef, Q, QuerySet

from annotations.language.texts import Refusal
from annotations.models import (
    Paraphrase,
    SemanticTemplate,
    User,
    Utterance,
    WorkItem,
    WorkShare,
    World,
)
from annotations.models.corpus import UtteranceStatus
from annotations.models.description import TemplateStatus
from annotations.models.queueing import DRAWS, PRIORITIES, WorkKind
from annotations.rows.synchronise import batches

# An adjudication compares two labels already, and a dispute is settled by one person.
DOUBLE_KINDS = (
    WorkKind.UNLABELLED,
    WorkKind.LOW_CONFIDENCE,
    WorkKind.DISAGREEMENT,
    WorkKind.REQUESTED,
)
BATCH = 500

ItemSubject = Utterance | SemanticTemplate | Paraphrase
MOST_AT_ONCE = 1000  # of each kind, so that nobody waits long for it


def shares_of(world: World) -> dict[str, int]:
    """Return the percentage of items that two people do, for each kind that may have one."""
    rows = dict(world.work_shares.values_list("kind", "percent"))
    return {kind: rows.get(kind, 0) for kind in DOUBLE_KINDS}


def people_for(kind: str, subject: str, draw: int, shares: dict[str, int]) -> int:
    """Return how many people are to do an item: labels of utterances alone can be compared."""
    is_double = subject == "utterance" and draw < shares.get(kind, 0) * DRAWS // 100
    return 2 if is_double else 1


@transaction.atomic
def set_share(world: World, kind: WorkKind, percent: int) -> None:
    """Let two people do ``percent`` of the items of ``kind``, those included that nobody has touched.

    Raises Refusal for a kind that one person does, and for what is no percentage.
    """
    if kind not in DOUBLE_KINDS or not 0 <= percent <= 100:
        raise Refusal(
            "Choose a share from 0 to 100 % of a kind that two people can do.", "no_such_share"
        )
    WorkShare.objects.update_or_create(world=world, kind=kind, defaults={"percent": percent})
    rows = WorkItem.objects.filter(world=world, kind=kind, utterance__isnull=False)
    untouched = rows.untouched()
    is_double = Q(draw__lt=percent * DRAWS // 100)
    untouched.filter(is_double, people=1).update(people=2, places=2)
    untouched.filter(~is_double, people=2).update(people=1, places=1)


@dataclass(frozen=True, slots=True)
class WantedItem:
    """What somebody is to look at, and the sentence that says why."""

    subject: ItemSubject
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
        reason=wanted.reason,
        title=title_of(wanted.subject),
        priority=PRIORITIES[kind],
        people=people,
        places=people,
        draw=draw,
        created_by=by,
        **{name: wanted.subject},
    )


def field_of(subject: ItemSubject) -> str:
    """Return the field of ``WorkItem`` that holds ``subject``."""
    return {Utterance: "utterance", SemanticTemplate: "template", Paraphrase: "paraphrase"}[
        type(subject)
    ]


def title_of(subject: ItemSubject) -> str:
    if isinstance(subject, SemanticTemplate):
        return subject.pattern
    return subject.text if isinstance(subject, Utterance) else subject.utterance


def draw_of(kind: str, name: str, key: int) -> int:
    """Return a number below ``DRAWS`` that looks random and is the same each time."""
    digest = hashlib.sha256(f"{kind}:{name}:{key}".encode()).digest()
    return int.from_bytes(digest[:4]) % DRAWS


def refill(world: World) -> int:
    """Add items for utterances without a form and for what is disputed. Return how many are new.

    What has an open item of any kind gets no other one.
    """
    unlabelled = [
        WantedItem(row, "Nobody has said yet what this means.")
        for row in _without_item(world, UtteranceStatus.UNLABELLED)
    ]
    disputed = []
    for row in _without_item(world, UtteranceStatus.DISPUTED):
        label = row.accepted_label
        who = (label and label.annotator) or "Somebody"
        reason = (label and label.reason) or "no reason was given"
        disputed.append(WantedItem(row, f"{who} disputes it: {reason}"))
    items = WorkItem.objects.open().filter(template=OuterRef("pk"))
    templates = SemanticTemplate.objects.filter(
        ~Exists(items), grammar__world=world, status=TemplateStatus.DISPUTED
    )
    for template in templates.order_by("pk")[:MOST_AT_ONCE]:
        disputed.append(WantedItem(template, "This template is disputed and makes no commands."))
    return enqueue(world, WorkKind.UNLABELLED, unlabelled) + enqueue(
        world, WorkKind.DISPUTED, disputed
    )


def _without_item(world: World, status: str) -> list[Utterance]:
    items = WorkItem.objects.open().filter(utterance=OuterRef("pk"))
    rows = world.utterances.filter(~Exists(items), status=status)
    return list(rows.order_by("pk")[:MOST_AT_ONCE])


# What a reviewer may ask somebody to look at: its kind → the rows of a world.
ASKABLE: dict[str, Callable[[World], QuerySet[Any]]] = {
    "utterance": lambda world: world.utterances.all(),
    "template": lambda world: SemanticTemplate.objects.filter(grammar__world=world),
    "paraphrase": lambda world: world.paraphrases.all(),
}


def ask_about(world: World, subject: ItemSubject, reason: str, by: User) -> bool:
    """Put ``subject`` into the queue, as people read it there. False where somebody is asked already."""
    wanted = [WantedItem(subject, f"{by} asks: {reason}")]
    with transaction.atomic():
        World.objects.hold().get(pk=world.pk)  # one asks at a time
        return bool(enqueue(world, WorkKind.REQUESTED, wanted, by=by))
