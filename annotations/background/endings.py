"""What has ended in a world: training runs, jobs and campaigns. A mark says what somebody was told, so that nothing
is told twice or left out."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any, NamedTuple

from django.db.models import Q
from django.utils import timezone

from annotations.background.kinds import kinds
from annotations.language.texts import Refusal
from annotations.models import Campaign, Job, World
from annotations.models.background import ENDED, rows_of

# A row may be seen so long after the moment that it bears: it is committed later, by the clock of another machine.
OVERLAP = timedelta(minutes=1)
MOST_AT_ONCE = 100
MOST_TOLD = 100  # keys of a mark, which stands in a header
LONGEST_MARK = 5_000  # characters
_MARK = re.compile(r"(\d{1,17})((?:_[a-z]+\d{1,18}\.\d{1,17})*)")
_TOLD = re.compile(r"_([a-z]+)(\d+)\.(\d+)")
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_MICROSECOND = timedelta(microseconds=1)


class Key(NamedTuple):
    """A kind, the number of its row, and the moment in microseconds: what begins anew ends more than once."""

    kind: str
    pk: int
    moment: int


@dataclass(frozen=True, slots=True)
class Ending:
    """``status`` is that of the work, ``waiting`` of a job that asks a question, and ``closed`` of a campaign."""

    kind: str
    pk: int
    status: str
    title: str
    failure: str
    at: datetime

    @property
    def key(self) -> Key:
        return Key(self.kind, self.pk, _moment(self.at))


@dataclass(frozen=True, slots=True)
class Mark:
    """What somebody was told: all until ``since``, and after it what is in ``told``; the last at ``moment``."""

    moment: int
    told: frozenset[Key] = frozenset()

    @classmethod
    def read(cls, text: str) -> Mark:
        """Read what ``str`` wrote. Raises Refusal."""
        found = _MARK.fullmatch(text) if len(text) <= LONGEST_MARK else None
        if found is None:
            sentence = (
                "This is not the id of an event. Leave it out to be told what ends from now on."
            )
            raise Refusal(sentence, "unreadable_event_id")
        told = (Key(kind, int(pk), int(moment)) for kind, pk, moment in _TOLD.findall(found[2]))
        return cls(int(found[1]), frozenset(told))

    def __str__(self) -> str:
        told = "".join(f"_{kind}{pk}.{moment}" for kind, pk, moment in sorted(self.told))
        return f"{self.moment}{told}"

    @property
    def since(self) -> datetime:
        """From when on rows are looked at: the overlap before ``moment``, less where very much has ended."""
        begin = self.moment - OVERLAP // _MICROSECOND
        if len(self.told) == MOST_TOLD:
            begin = max(begin, min(key.moment for key in self.told))
        return _EPOCH + begin * _MICROSECOND

    def after(self, ending: Ending) -> Mark:
        """Return the mark of somebody who was told of ``ending`` too."""
        moment = max(self.moment, ending.key.moment)
        least = moment - OVERLAP // _MICROSECOND
        told = (key for key in (*self.told, ending.key) if key.moment > least)
        return Mark(moment, _newest(told))


def begin_mark(world: World) -> Mark:
    """Return the mark of somebody who wants to be told what ends from now on."""
    now = Mark(_moment(timezone.now()))
    return Mark(
        now.moment, _newest(each.key for each in _endings(world, now.since, "-finished_at"))
    )


def endings_after(world: World, mark: Mark) -> list[tuple[Ending, Mark]]:
    """Return what has ended in ``world`` beyond ``mark``, the oldest first, each with the mark after it."""
    new = sorted(
        (each for each in _endings(world, mark.since, "finished_at") if each.key not in mark.told),
        key=lambda each: each.key.moment,
    )
    told: list[tuple[Ending, Mark]] = []
    for each in new[:MOST_AT_ONCE]:
        mark = mark.after(each)
        told.append((each, mark))
    return told


def _endings(world: World, since: datetime, order: str) -> Iterator[Ending]:
    """Yield what has ended after ``since``, of each kind of work the first in ``order`` that one answer may need."""
    for kind in kinds():
        all_rows: Any = rows_of(kind)  # each kind has a world
        rows = all_rows.filter(world=world, status__in=ENDED, finished_at__gt=since)
        for row in rows.order_by(order)[: MOST_AT_ONCE + MOST_TOLD]:
            is_asking = isinstance(row, Job) and row.is_waiting_for_answer
            title = row.title if isinstance(row, Job) else str(row)
            status = "waiting" if is_asking else row.status
            yield Ending(row.noun, row.pk, status, title, row.failure, row.finished_at)
    is_late = Q(closed_at__gt=since) | Q(ends_at__gt=since, ends_at__lte=timezone.now())
    for campaign in Campaign.objects.filter(is_late, world=world):
        at = campaign.ended_at
        if at is not None and at > since:
            yield Ending("campaign", campaign.pk, "closed", campaign.name, "", at)


def _newest(keys: Iterable[Key]) -> frozenset[Key]:
    return frozenset(sorted(keys, key=lambda key: key.moment)[-MOST_TOLD:])


def _moment(at: datetime) -> int:
    return (at - _EPOCH) // _MICROSECOND
