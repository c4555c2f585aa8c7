"""Verbs: ask for a look at a row, and give the first items of a list to somebody."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.db.models import QuerySet

from annotations.models import SemanticTemplate, User, WorkKind, World
from annotations.models.queueing import WorkItemQuerySet
from annotations.queueing.enqueuing import Subject, WantedItem, enqueue
from annotations.queueing.giving import NotForThem, assign

# What a reviewer may ask somebody to look at: its kind → the rows of a world.
ASKABLE: dict[str, Callable[[World], QuerySet[Any]]] = {
    "utterance": lambda world: world.utterances.all(),
    "template": lambda world: SemanticTemplate.objects.filter(grammar__world=world),
    "paraphrase": lambda world: world.paraphrases.all(),
}


def ask_about(world: World, subject: Subject, reason: str, by: User) -> bool:
    """Put ``subject`` into the queue, as people read it there. False where somebody is asked already."""
    wanted = [WantedItem(subject, f"{by} asks: {reason}")]
    return bool(enqueue(world, WorkKind.REQUESTED, wanted, by=by))


def assign_first(rows: WorkItemQuerySet, person: User, count: int, by: User) -> int:
    """Give ``person`` the ``count`` most urgent of the items that they may do. Return how many it were."""
    given = 0
    for item in rows.takeable_by(person).order_by("-priority", "id")[:count]:
        try:
            assign(item, person, by=by)
            given += 1
        except NotForThem:
            continue  # taken meanwhile, or not for this person
    return given
