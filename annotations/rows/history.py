"""The history of rows: what they were at each version, since when, and who changed them.

A row that was imported has no history before somebody changes it; what it was is kept then, so that
importing many rows costs nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from django.db import connection, models
from django.utils import timezone

from annotations.models import Editable, User, World
from annotations.models.editing import HistoryEntry

ADDED, CHANGED, DELETED = "+", "~", "-"
BATCH = 500  # rows a statement
AS_IMPORTED, OF_IMPORT, RESTORED = "as it was before", "import", "restored"
NORMALISED = "normalised"  # by nobody
WHAT = {ADDED: "Added", CHANGED: "Changed", DELETED: "Deleted"}


def keep(rows: Iterable[Editable], kind: str, by: User | None = None, reason: str = "") -> None:
    """Write what ``rows``, all of one model, are now into its history.

    Args:
        kind: what happened to them: ``ADDED``, ``CHANGED`` or ``DELETED``.
        by: who did it; None for what no person did.
    """
    _store([_entry_of(row, kind, by, reason) for row in rows])


def keep_change(before: Editable, now: Editable, by: User | None = None, reason: str = "") -> None:
    """Record that a row changed from ``before`` to ``now``; in one statement where it is new."""
    entries = [_entry_of(now, CHANGED, by, reason)]
    is_known = before.version > 1 and history_of(type(now)).filter(id=now.pk).exists()
    if not is_known:
        entries.insert(0, _entry_of(before, ADDED, None, AS_IMPORTED))
    _store(entries)


def keep_many(
    rows: models.QuerySet[Any], kind: str, by: User | None = None, reason: str = ""
) -> None:
    """Do what ``keep`` does for the rows of a query, in one statement."""
    model = history_of(rows.model).model
    kept = {
        "history_date": timezone.now(),
        "history_type": kind,
        "history_user": by and by.pk,
        "history_change_reason": reason,
    }
    columns = [field.attname for field in model.tracked_fields]
    values = {}
    for name, value in kept.items():
        field = model._meta.get_field(name)
        # The value of a reference is a key.
        plain = field.target_field if field.is_relation else field
        values[f"kept_{name}"] = models.Value(value, output_field=plain)
    chosen = rows.order_by().annotate(**values).values_list(*columns, *values)
    select, parameters = chosen.query.sql_with_params()
    names = [field.column for field in model.tracked_fields]
    names += [model._meta.get_field(name).column for name in kept]
    into = ", ".join(map(connection.ops.quote_name, names))
    table = connection.ops.quote_name(model._meta.db_table)
    with connection.cursor() as cursor:
        cursor.execute(f"INSERT INTO {table} ({into}) {select}", parameters)


def _entry_of(row: Editable, kind: str, by: User | None, reason: str) -> Any:
    model = history_of(type(row)).model
    values = {field.attname: getattr(row, field.attname) for field in model.tracked_fields}
    return model(
        history_date=timezone.now(),
        history_type=kind,
        history_user=by,
        history_change_reason=reason,
        **values,
    )


def _store(entries: list[Any]) -> None:
    if entries:
        type(entries[0])._default_manager.bulk_create(entries, batch_size=BATCH)


def keep_first(model: type[Editable], keys: Sequence[int]) -> None:
    """Keep what the rows with these ``keys`` are if they have no history yet. Call it before they change."""
    for start in range(0, len(keys), BATCH):
        some = keys[start : start + BATCH]
        known = set(history_of(model).filter(id__in=some).values_list("id", flat=True))
        unknown = [key for key in some if key not in known]
        keep(model._default_manager.filter(pk__in=unknown), ADDED, reason=AS_IMPORTED)


def history_of(model: type[Editable]) -> Any:
    """Return the manager of the model's history, newest entry first."""
    return model.history


def keys_changed_by_people(model: type[Editable], world: World) -> set[int]:
    """Return the keys of the rows that somebody changed here since they were imported."""
    entries = history_of(model).filter(**{model.world_path: world})
    of_people = entries.exclude(history_change_reason__in=(OF_IMPORT, AS_IMPORTED, NORMALISED))
    return set(of_people.values_list("id", flat=True))


def entry_at(row: Editable, version: int) -> HistoryEntry | None:
    """Return the history entry of ``row`` as it was at ``version``; None where nobody kept it."""
    entry: HistoryEntry | None = (
        history_of(type(row))
        .filter(id=row.pk, version=version)
        .exclude(history_type=DELETED)
        .order_by("-history_id")
        .first()
    )
    return entry


def what_happened(entry: Any) -> str:
    """Say what made the version that a history entry keeps."""
    match entry.history_change_reason:
        case reason if reason == AS_IMPORTED:
            return "First known version"
        case reason if reason == RESTORED:
            return "Restored"
        case reason if reason == NORMALISED:
            return "Texts normalised"
        case reason if reason == OF_IMPORT:
            return f"{WHAT[entry.history_type]} by an import"
    return WHAT[entry.history_type]
