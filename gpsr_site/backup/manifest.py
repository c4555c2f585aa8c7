"""``manifest.json`` of a backup: which version wrote it, and what has to be in it."""

from __future__ import annotations

import json
import zipfile
from dataclasses import asdict, dataclass, field

from django.db import connections
from django.db.migrations.loader import MigrationLoader

from gpsr_site.backup.tables import APPS

NAME = "manifest.json"
FORMAT, VERSION = "gpsr-workbench-backup", 1


@dataclass
class Part:
    """A table or file: its rows (of a table), its bytes, and the SHA-256 of what it holds."""

    bytes: int
    sha256: str
    rows: int | None = None


@dataclass
class Manifest:
    """``migrations`` names the newest of each application; ``missing`` files vanished while they were read."""

    created_at: str
    database: str
    migrations: dict[str, str]
    tables: dict[str, Part] = field(default_factory=dict)
    files: dict[str, Part] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)

    def as_json(self) -> str:
        values = {"format": FORMAT, "version": VERSION, **asdict(self)}
        return json.dumps(values, indent=1, sort_keys=True)


def read_manifest(archive: zipfile.ZipFile) -> Manifest:
    """Return the manifest of a backup.

    Raises:
        ValueError: the archive is no backup, or one of another version.
    """
    try:
        values = json.loads(archive.read(NAME))
        form, version = values.pop("format"), values.pop("version")
    except (KeyError, ValueError, AttributeError) as error:
        raise ValueError("This is no backup: “manage.py backup FILE” writes one.") from error
    if (form, version) != (FORMAT, VERSION):
        raise ValueError(f"This is {form} {version}; this version reads {FORMAT} {VERSION}.")
    for name in ("tables", "files"):
        values[name] = {key: Part(**part) for key, part in values[name].items()}
    return Manifest(**values)


def newest_migrations() -> dict[str, str]:
    """Return the newest migration of each application that the database has.

    Raises:
        ValueError: the database lacks a migration of this version.
    """
    loader = MigrationLoader(connections["default"])
    ours = {key for key in loader.disk_migrations if key[0] in APPS}
    if ours - set(loader.applied_migrations):
        raise ValueError("The database is not that of this version. Run: manage.py migrate")
    return {app: max(name for label, name in ours if label == app) for app in APPS}
