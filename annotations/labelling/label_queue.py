"""Which utterance a person labels next, and how far everybody is."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from django.db.models import Avg, Exists, OuterRef, QuerySet
from django.utils import timezone

from annotations.models import Assignment, Label, User, Utterance, UtteranceStatus, World
from annotations.models.corpus import UtteranceQuerySet
from annotations.rows.kept import kept

LAST_SHOWN = 5


@dataclass(frozen=True, slots=True)
class LabellingProgress:
    """How many utterances there are and how many of them somebody has answered; what one person did today.

    ``seconds`` is the mean time of one of their answers; None before the first.
    """

    total: int
    waiting: int
    today: int
    seconds: float | None

    @property
    def done(self) -> int:
        return self.total - self.waiting


def next_utterance(
    rows: UtteranceQuerySet, user: User, without: Collection[int] = ()
) -> Utterance | None:
    """Return the oldest of ``rows`` that ``user`` has not answered or skipped, and that nobody else holds.

    ``without`` are the keys of those that the person has on the page.
    """
    held = Assignment.objects.held().filter(item__utterance=OuterRef("pk")).exclude(person=user)
    left = rows.unanswered_by(user).exclude(pk__in=without).exclude(Exists(held))
    return left.select_related("world").order_by("pk").first()


def progress_of(world: World, user: User) -> LabellingProgress:
    """Count the utterances of ``world`` (of very many, as of a while ago), and what ``user`` answered today."""
    midnight = timezone.localtime().replace(hour=0, minute=0, second=0, microsecond=0)
    today = Label.objects.of_world(world).valid().filter(annotator=user, created_at__gte=midnight)
    total, waiting = kept(
        ("labelled", world.pk), lambda: _count_utterances(world), lambda counted: sum(counted)
    )
    return LabellingProgress(
        total=total,
        waiting=waiting,
        today=today.count(),
        seconds=today.aggregate(mean=Avg("seconds"))["mean"],
    )


def _count_utterances(world: World) -> tuple[int, int]:
    rows = world.utterances.exclude(status=UtteranceStatus.EXCLUDED)
    return rows.count(), world.utterances.unlabelled().count()


def last_labels(world: World, user: User) -> QuerySet[Label]:
    """Return the newest answers of ``user``, the last one first."""
    rows = Label.objects.of_world(world).valid().filter(annotator=user)
    return rows.select_related("utterance").order_by("-pk")[:LAST_SHOWN]
