"""Make stored rows equal to wanted ones, and leave every row that is right already as it is."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from itertools import islice
from operator import attrgetter
from typing import Any, Generic, TypeVar

from django.db.models import F, Model, QuerySet

from annotations.models import Editable, User
from annotations.models.editing import Placed
from annotations.rows.history import (
    ADDED,
    CHANGED,
    DELETED,
    OF_IMPORT,
    RESTORED,
    keep,
    keep_first,
)

Row = TypeVar("Row", bound=Model)
BATCH = 500  # rows a statement; SQLite takes a limited number of parameters
PLACE_FIELDS = frozenset({"line", "position"})  # where a row stands, not what it says


@dataclass(frozen=True, slots=True)
class Changes:
    """How many rows were added, changed and removed; ``moved`` ones differ by nothing but their place."""

    added: int = 0
    changed: int = 0
    removed: int = 0
    moved: int = 0

    def as_json(self) -> dict[str, int]:
        return asdict(self)

    def __add__(self, other: Changes) -> Changes:
        return Changes(
            self.added + other.added,
            self.changed + other.changed,
            self.removed + other.removed,
            self.moved + other.moved,
        )

    @property
    def is_none(self) -> bool:
        """Whether every row was right already, but perhaps for its place."""
        return not (self.added or self.changed or self.removed)


@dataclass
class RowPlan(Generic[Row]):
    """What it takes to make stored rows equal to wanted ones. Nothing is written before ``apply``.

    ``kept`` stay though nobody wants them. ``restored`` are rows with the keys of deleted ones, and
    ``left_out`` wanted ones that are not stored, each with the reason (``annotations.rows.decisions``).
    """

    model: type[Row]
    fields: Sequence[str]
    new: list[Row]
    changed: list[Row]
    moved: list[Row]
    removed: list[Row]
    kept: list[Row] = field(default_factory=list)
    restored: list[Row] = field(default_factory=list)
    left_out: list[tuple[Row, str]] = field(default_factory=list)

    @property
    def changes(self) -> Changes:
        added = len(self.new) + len(self.restored)
        return Changes(added, len(self.changed), len(self.removed), len(self.moved))

    def apply(self, by: User | None = None) -> Changes:
        """Add, change and remove the rows. To be called inside a transaction.

        ``by`` is the author of the changes in the history of rows that people edit.
        """
        self.apply_to_stored(by)
        self.model._default_manager.bulk_create(self.new, batch_size=BATCH)
        return self.changes

    def apply_to_stored(self, by: User | None = None) -> None:
        """Change and remove rows, and leave the new ones to the caller."""
        fields = list(self.fields)
        if issubclass(self.model, Editable):
            keep_first(self.model, [row.pk for row in self.changed + self.removed])
            changed = _editable(self.changed)  # a row that only moves is no new version
            for row in changed:
                row.version += 1
            keep(changed, CHANGED, by, OF_IMPORT)
            keep(_editable(self.removed), DELETED, by, OF_IMPORT)
            fields.append("version")
        for batch in batches(self.removed):
            self.model._default_manager.filter(pk__in=[row.pk for row in batch]).delete()
        if self.changed or self.moved:
            rows = self.changed + self.moved
            if "position" in fields:
                # Out of the way first, so that no position is ever taken twice in between.
                for batch in batches(rows):
                    chosen = self.model._default_manager.filter(pk__in=[row.pk for row in batch])
                    chosen.update(position=F("position") + 1_000_000_000)
            names = [name.removesuffix("_id") for name in fields]
            self.model._default_manager.bulk_update(rows, names, batch_size=BATCH)
        if self.restored:
            self.model._default_manager.bulk_create(self.restored, batch_size=BATCH)
            keep(_editable(self.restored), ADDED, by, RESTORED)


def _editable(rows: Iterable[Model]) -> list[Editable]:
    return [row for row in rows if isinstance(row, Editable)]


def synchronise(
    stored: QuerySet[Row],
    wanted: Sequence[Row],
    key: Callable[[Row], Hashable],
    fields: Sequence[str],
    is_kept: Callable[[Row], bool] = lambda row: False,
    by: User | None = None,
) -> Changes:
    """Add, change and remove as few rows as it takes: ``plan``, carried out at once.

    To be called inside a transaction.
    """
    return plan(stored, wanted, key, fields, is_kept).apply(by)


def plan(
    stored: QuerySet[Row],
    wanted: Sequence[Row],
    key: Callable[[Row], Hashable],
    fields: Sequence[str],
    is_kept: Callable[[Row], bool] = lambda row: False,
) -> RowPlan[Row]:
    """Return what it takes to make ``stored`` equal to ``wanted``.

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
    changed: list[Row] = []
    moved: list[Row] = []
    new: list[Row] = []
    for target in wanted:
        match = waiting[key(target)].popleft() if waiting[key(target)] else None
        if match is None:
            new.append(target)
        elif differing := _take_over(match, target, fields):
            (moved if differing <= PLACE_FIELDS else changed).append(match)
    left = [row for rows in waiting.values() for row in rows]
    kept = [row for row in left if is_kept(row)]
    if "position" in fields:  # those that are kept come behind those that are wanted
        for position, row in enumerate(sorted(kept, key=attrgetter("position")), len(wanted)):
            assert isinstance(row, Placed)
            if row.position != position:
                row.position = position
                moved.append(row)
    removed = [row for row in left if not is_kept(row)]
    return RowPlan(stored.model, fields, new, changed, moved, removed, kept)


def _take_over(row: Row, target: Row, fields: Sequence[str]) -> set[str]:
    """Make ``row`` equal to ``target`` and return the fields in which it differed."""
    differing = {name for name in fields if getattr(row, name) != getattr(target, name)}
    for name in differing:
        setattr(row, name, getattr(target, name))
    return differing


def batches(rows: Iterable[Any], size: int = BATCH) -> Iterator[list[Any]]:
    """Yield the rows in lists of at most ``size``."""
    remaining = iter(rows)
    while batch := list(islice(remaining, size)):
        yield batch
