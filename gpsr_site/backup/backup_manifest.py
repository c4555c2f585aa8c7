"""``manifest.json`` of a backup: which version wrote it, and what has to be in it."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from datetime import datetime
from typing import Any

from django.db import connections
from django.db.migrations.loader import MigrationLoader

from annotations.language.texts import Refusal
from gpsr_site.backup.backup_tables import APPS

NAME = "manifest.json"
FORMAT, VERSION = "gpsr-workbench-backup", 1
MOST_BYTES = 100_000_000  # of the manifest itself, which names each file


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_moment(value: Any) -> bool:
    try:
        return bool(datetime.fromisoformat(value))
    except (TypeError, ValueError):
        return False


def _is_count(value: Any) -> bool:
    return type(value) is int and value >= 0


# What each value of the manifest has to be, and of each part in it.
SHAPE: Mapping[str, Callable[[Any], bool]] = {
    "created_at": _is_moment,
    "database": _is_text,
    "migrations": lambda value: isinstance(value, dict) and all(map(_is_text, value.values())),
    "tables": lambda value: isinstance(value, dict),
    "files": lambda value: isinstance(value, dict),
    "missing": lambda value: isinstance(value, list) and all(map(_is_text, value)),
}
SHAPE_OF_TABLE = {"bytes": _is_count, "sha256": _is_text, "rows": _is_count}
SHAPE_OF_FILE = {**SHAPE_OF_TABLE, "rows": lambda value: value is None}


@dataclass
class BackupPart:
    """A table or file: its rows (of a table), its bytes, and the SHA-256 of what it holds."""

    bytes: int
    sha256: str
    rows: int | None = None


@dataclass
class BackupManifest:
    """``migrations`` names the newest of each application; ``missing`` files vanished while they were read."""

    created_at: str
    database: str
    migrations: dict[str, str]
    tables: dict[str, BackupPart] = field(default_factory=dict)
    files: dict[str, BackupPart] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)

    def as_json(self) -> str:
        values = {"format": FORMAT, "version": VERSION, **asdict(self)}
        return json.dumps(values, indent=1, sort_keys=True)


def read_manifest(archive: zipfile.ZipFile) -> BackupManifest:
    """Return the manifest of a backup.

    Raises:
        Refusal: the archive is no backup, or one of another version.
    """
    try:
        is_small = archive.getinfo(NAME).file_size <= MOST_BYTES
        values = json.loads(archive.read(NAME)) if is_small else {}
        form, version = values.pop("format"), values.pop("version")
    except (KeyError, ValueError, AttributeError, TypeError, RecursionError) as error:
        said = "This is no backup: “gpsr-workbench manage backup FILE” writes one."
        raise Refusal(said, "no_backup") from error
    if (form, version) != (FORMAT, VERSION):
        what = f"{str(form)[:40]} {str(version)[:40]}"
        said = f"This is {what}; this version reads {FORMAT} {VERSION}."
        raise Refusal(said, "other_format")
    _require_shape("", values, SHAPE)
    for name, shape in (("tables", SHAPE_OF_TABLE), ("files", SHAPE_OF_FILE)):
        for key, part in values[name].items():
            _require_shape(f"{name} → {key[:80]} → ", part, shape)
        values[name] = {key: BackupPart(**part) for key, part in values[name].items()}
    return BackupManifest(**values)


def _require_shape(where: str, values: Any, shape: Mapping[str, Callable[[Any], bool]]) -> None:
    """Raise Refusal where ``values`` has other keys than ``shape``, or other values."""
    given = values.keys() if isinstance(values, dict) else set()
    wrong = (set(given) ^ set(shape)) or {
        name for name, is_right in shape.items() if not is_right(values[name])
    }
    if wrong:
        names = ", ".join(f"{where}{name[:80]}" for name in sorted(wrong)[:5])
        said = f"{NAME} of this backup is not as it was written: see {names}. Nothing was restored."
        raise Refusal(said, "backup_damaged")


def newest_migrations() -> dict[str, str]:
    """Return the newest migration of each application that the database has.

    Raises:
        Refusal: the database lacks a migration of this version.
    """
    loader = MigrationLoader(connections["default"])
    ours = {key for key in loader.disk_migrations if key[0] in APPS}
    if ours - set(loader.applied_migrations):
        said = "The database is not that of this version. Run: gpsr-workbench manage migrate"
        raise Refusal(said, "not_migrated")
    return {app: max(name for label, name in ours if label == app) for app in APPS}
