"""Makes stored rows equal to wanted ones and leaves every row alone that is right already."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import islice
from typing import Any, TypeVar

from django.db.models import F, Model, QuerySet

Row = TypeVar("Row", bound=Model)
BATCH = 500  # rows a statement; SQLite takes a limited number of parameters


@dataclass(frozen=True, slots=True)
class Changes:
    """How many rows were added, changed and removed."""

    added: int = 0
    changed: int = 0
    removed: int = 0

    def as_json(self) -> dict[str, int]:
        return asdict(self)

    def __add__(self, other: Changes) -> Changes:
        return Changes(
            self.added + other.added, self.changed + other.changed, self.removed + other.removed
        )


def synchronise(
    stored: QuerySet[Row],
    wanted: Sequence[Row],
    key: Callable[[Row], Hashable],
    fields: Sequence[str],
    is_kept: Callable[[Row], bool] = lambda row: False,
) -> Changes:
    """Adds, changes and removes as few rows as it takes. To be called inside a transaction.

    Args:
        stored: the rows that may be changed.
        wanted: unsaved rows, in order. A wanted row is the stored one with the same ``key``, the
            first with the first where several share it.
        fields: what to compare and to change of such a row (foreign keys by their ``_id``).
        is_kept: whether a stored row stays though nobody wants it. Where rows have a ``position``,
            the kept ones stand behind the wanted ones.
    """
    waiting: dict[Hashable, deque[Row]] = defaultdict(deque)
    for row in stored:
        waiting[key(row)].append(row)
    changed, new = [], []
    for target in wanted:
        row = waiting[key(target)].popleft() if waiting[key(target)] else None
        if row is None:
            new.append(target)
        elif _take_over(row, target, fields):
            changed.append(row)
    left = [row for rows in waiting.values() for row in rows]
    kept = [row for row in left if is_kept(row)]
    removed = [row for row in left if not is_kept(row)]
    if "position" in fields:
        changed += _moved_behind(kept, len(wanted))
    _remove(stored.model, removed)
    if changed:
        _rewrite(stored.model, changed, fields)
    stored.model._default_manager.bulk_create(new, batch_size=BATCH)
    return Changes(len(new), len(changed), len(removed))


def _take_over(row: Row, target: Row, fields: Sequence[str]) -> bool:
    """Whether ``row`` differed from ``target``; afterwards it does not."""
    differing = [name for name in fields if getattr(row, name) != getattr(target, name)]
    for name in differing:
        setattr(row, name, getattr(target, name))
    return bool(differing)


def _moved_behind(kept: list[Row], first: int) -> list[Row]:
    moved = []
    for position, row in enumerate(sorted(kept, key=lambda each: each.position), start=first):
        if row.position != position:
            row.position = position
            moved.append(row)
    return moved


def _remove(model: type[Row], rows: list[Row]) -> None:
    for batch in batches(rows):
        model._default_manager.filter(pk__in=[row.pk for row in batch]).delete()


def _rewrite(model: type[Row], rows: list[Row], fields: Sequence[str]) -> None:
    if "position" in fields:
        _clear_positions(model, rows)
    names = [name.removesuffix("_id") for name in fields]
    model._default_manager.bulk_update(rows, names, batch_size=BATCH)


def _clear_positions(model: type[Row], rows: list[Row]) -> None:
    """Moves the rows out of the way, so that no position is ever taken twice in between."""
    for batch in batches(rows):
        chosen = model._default_manager.filter(pk__in=[row.pk for row in batch])
        chosen.update(position=F("position") + 1_000_000_000)


def batches(rows: Iterable[Any], size: int = BATCH) -> Iterator[list[Any]]:
    """The rows in lists of at most ``size``."""
    remaining = iter(rows)
    while batch := list(islice(remaining, size)):
        yield batch
