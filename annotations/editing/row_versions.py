"""The versions of a row as pages show them: who made each, when, and what changed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from typing import Any

from annotations.models import User, World
from annotations.rows.history import AS_IMPORTED, DELETED, what_happened
from annotations.rows.row_kinds import FORM_FIELDS, EditableKind, as_text, label_of
from annotations.showing.form_presentation import Pieces, compare

MOST_SHOWN = 30


@dataclass(frozen=True, slots=True)
class FieldChange:
    """What became of one field; ``before`` is empty where there was nothing before."""

    label: str
    before: Pieces
    after: Pieces


@dataclass(frozen=True, slots=True)
class Version:
    """An entry of a history. ``moment`` is None where it is not known when the row became this."""

    entry: int
    number: int
    what: str
    author: User | None
    moment: datetime | None
    changes: tuple[FieldChange, ...]
    is_deletion: bool
    is_current: bool


@dataclass(frozen=True, slots=True)
class RowHistory:
    """Some versions of a row, newest first; ``older`` is the entry to go on from, None at the end."""

    versions: tuple[Version, ...]
    older: int | None


def history_of_row(
    kind: EditableKind, world: World, pk: int, before: int | None = None
) -> RowHistory:
    """Read the versions of a row that are older than the entry ``before``; without one, the newest."""
    entries = kind.entries_of(world).filter(id=pk)
    newest = entries.values_list("history_id", flat=True).first()
    if before is not None:
        entries = entries.filter(history_id__lt=before)
    some = list(entries[: MOST_SHOWN + 1])
    shown = some[:MOST_SHOWN]
    pairs = pairwise([*some, None] if len(some) <= MOST_SHOWN else some)
    versions = tuple(
        Version(
            entry=entry.history_id,
            number=entry.version,
            what=what_happened(entry),
            author=entry.history_user,
            moment=None if entry.history_change_reason == AS_IMPORTED else entry.history_date,
            changes=tuple(_changes(kind, entry, older)),
            is_deletion=entry.history_type == DELETED,
            is_current=entry.history_id == newest,
        )
        for entry, older in pairs
    )
    return RowHistory(versions, shown[-1].history_id if len(some) > MOST_SHOWN else None)


def _changes(kind: EditableKind, entry: Any, older: Any) -> Iterator[FieldChange]:
    for name in kind.model.edited_fields:
        new = as_text(getattr(entry, name))
        if older is None or older.history_type == DELETED:
            if new:
                yield FieldChange(label_of(name), [], [("same", new)])
            continue
        old = as_text(getattr(older, name))
        if old != new:
            yield FieldChange(label_of(name), *compare(old, new, name in FORM_FIELDS))
