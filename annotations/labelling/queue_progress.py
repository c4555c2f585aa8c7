"""What waits in a queue, and what everybody has done."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from datetime import date, timedelta

from django.db.models import Count, Q
from django.db.models.functions import TruncDate
from django.utils import timezone

from annotations.models import Assignment, WorkKind, World
from annotations.rows.kept import kept

DAYS = 30


@dataclass(frozen=True, slots=True)
class PersonProgress:
    """Items that one person has done, day by day; ``days`` go with ``QueueProgress.days``."""

    person: str
    days: tuple[int, ...]

    @property
    def total(self) -> int:
        return sum(self.days)


@dataclass(frozen=True, slots=True)
class QueueProgress:
    """The last ``DAYS`` days. They begin with the first day of work among them."""

    days: tuple[date, ...]
    people: tuple[PersonProgress, ...]

    @property
    def total(self) -> int:
        return sum(self.totals)

    @property
    def totals(self) -> list[int]:
        return [sum(counts) for counts in zip(*(each.days for each in self.people), strict=True)]


def progress_of(world: World) -> QueueProgress:
    """Count the items that people have done, by person and day; of very many, those of a while ago."""
    return kept(("done", world.pk), lambda: _count_done(world), lambda done: done.total)


def _count_done(world: World) -> QueueProgress:
    today = timezone.localdate()
    since = timezone.now() - timedelta(days=DAYS)
    rows = (
        Assignment.objects.done()
        .filter(item__world=world, done_at__gte=since)
        .annotate(day=TruncDate("done_at"))
        .values_list("person__username", "day")
        .annotate(count=Count("pk"))
        .order_by()
    )
    counts: dict[str, dict[date, int]] = defaultdict(dict)
    for person, day, count in rows:
        counts[person or "deleted account"][day] = count
    if not counts:
        return QueueProgress((), ())
    first = min(day for days in counts.values() for day in days)
    days = tuple(first + timedelta(days=number) for number in range((today - first).days + 1))
    people = [
        PersonProgress(person, tuple(done.get(day, 0) for day in days))
        for person, done in counts.items()
    ]
    return QueueProgress(days, tuple(sorted(people, key=lambda each: (-each.total, each.person))))


def open_by_kind(world: World) -> list[tuple[str, str, int, int]]:
    """Return kind, label, open items and those of them that are free; kinds without any are left out.

    Of very many, those of a while ago.
    """
    counts = kept(
        ("open", world.pk), lambda: _count_open(world), lambda given: sum(map(sum, given.values()))
    )
    return [(kind, kind.label, *counts[kind]) for kind in WorkKind if kind in counts]


def _count_open(world: World) -> dict[str, tuple[int, int]]:
    rows = world.work_items.open().order_by().values_list("kind")
    counted = rows.annotate(items=Count("pk"), free=Count("pk", Q(places__gt=0)))
    return {kind: (items, free) for kind, items, free in counted}
