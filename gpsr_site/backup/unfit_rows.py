"""Find the rows of an older version that do not fit into every database, whatever version the tables are of."""

from __future__ import annotations

from collections.abc import Iterator

from django.db import connection
from django.db.migrations.loader import MigrationLoader

from gpsr_site.backup.backup_tables import CHUNK, BackupTable, Unportable

MOST_NAMED = 20


def is_before_squash() -> bool:
    """Tell whether the database has some, not all, of the migrations that a squashed one replaces."""
    loader = MigrationLoader(connection)
    applied = loader.applied_migrations.keys()
    return any(
        key not in applied and not applied.isdisjoint(migration.replaces)
        for key, migration in loader.replacements.items()
    )


def unfit_rows() -> Iterator[Unportable]:
    """Yield each row that a column of today cannot hold, in the tables as they are now."""
    if is_before_squash():
        return  # no model says what its tables are like
    loader = MigrationLoader(connection)
    applied = [key for key in loader.applied_migrations if key in loader.graph.nodes]
    there, wanted = loader.project_state(applied).apps, loader.project_state().apps
    for model in there.get_models(include_auto_created=True):
        label = model._meta.label_lower
        has_successor = model._meta.model_name in wanted.all_models[model._meta.app_label]
        columns = wanted.get_model(label)._meta.concrete_fields if has_successor else ()
        limits = {field.attname: field for field in columns}
        yield from _unfit_rows_of(BackupTable(model, limits))


def _unfit_rows_of(table: BackupTable) -> Iterator[Unportable]:
    names = [field.attname for field in table.fields]
    rows = table.model._base_manager.order_by("pk").values_list(*names)
    for row in rows.iterator(chunk_size=CHUNK):
        if fault := table.fault(row):
            yield fault


def say_unfit_rows() -> str:
    """Return which rows do not fit, a line each, and what to do about them; empty where all fit."""
    faults = unfit_rows()
    named = [fault for fault, _ in zip(faults, range(MOST_NAMED), strict=False)]
    if not named:
        return ""
    rest = "" if next(faults, None) is None else "\nThere are more, which are named next time."
    lines = "\n".join(f"{fault.message} {fault.remedy}" for fault in named)
    return (
        f"Rows of an older version do not fit into today's tables:\n{lines}{rest}\n"
        "Keep a copy of the database, mend these rows with that version or by SQL, then run: "
        "gpsr-workbench manage migrate"
    )
