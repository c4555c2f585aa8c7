"""Verb: make an installation from a backup."""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path, PurePosixPath
from typing import IO, Any

from django.conf import settings
from django.core.management.color import no_style
from django.db import connection, transaction

from annotations.models import LogInSession
from gpsr_site.backup.manifest import Manifest, Part, newest_migrations, read_manifest
from gpsr_site.backup.tables import Table, tables

FOLDERS = ("runs", "jobs")
FILE_CHUNK = 1024 * 1024
BATCH = 2000
Say = Callable[[str], None]


class Damaged(ValueError):
    """A part of the backup is not what its manifest says."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"{name} was changed or damaged after the backup was written. Nothing was restored."
        )


def restore(path: Path, replace: bool = False, say: Say = lambda sentence: None) -> Manifest:
    """Fill this installation from the backup at ``path``: all of it, or nothing.

    With ``replace`` the rows that are here are deleted, and the files put into a folder beside.

    Raises:
        ValueError: the file is no backup, is damaged, is of another version, or this installation
            holds something and ``replace`` was not asked for.
    """
    staging = settings.VAR_DIR / ".restoring"
    shutil.rmtree(staging, ignore_errors=True)
    try:
        with zipfile.ZipFile(path) as archive:
            manifest = read_manifest(archive)
            _refuse_other_versions(manifest)
            if not replace:
                _refuse_to_overwrite()
            for name, part in manifest.files.items():
                _extract(archive, name, part, staging)
            with transaction.atomic():
                if replace:
                    _empty()
                _fill(archive, manifest, say)
                connection.check_constraints()
                _move_files(staging, manifest, say)
    except zipfile.BadZipFile as error:
        raise ValueError(f"{path} cannot be read as a backup: {error}.") from error
    finally:
        shutil.rmtree(staging, ignore_errors=True)
    return manifest


def _refuse_other_versions(manifest: Manifest) -> None:
    here = newest_migrations()
    for app, name in manifest.migrations.items():
        if here.get(app) != name:
            raise ValueError(
                f"The backup is of the version whose newest migration of {app} is {name}; here it is "
                f"{here.get(app)}. Install that version, restore, then upgrade."
            )
    if set(manifest.tables) != {table.name for table in tables()}:
        raise ValueError(
            "The backup has other tables than this installation. Single sign-on has to be set up in "
            "both, or in neither."
        )


def _refuse_to_overwrite() -> None:
    for table in tables():
        if table.model._base_manager.exists():
            raise ValueError(
                f"This installation is not empty: it has rows of {table.name}. Restore into an empty "
                "one, or give --replace, which deletes everything that is here."
            )
    if settings.RUNS_DIR.is_dir() and any(settings.RUNS_DIR.iterdir()):
        raise ValueError(f"{settings.RUNS_DIR} holds runs of another database. Move it away first.")


def _empty() -> None:
    """Delete all rows. The constraints between them are looked at when the transaction ends."""
    with connection.cursor() as cursor:
        names = [table.model._meta.db_table for table in tables()]
        names += [LogInSession._meta.db_table, *(each for each in _tables_of_users())]
        quoted = [connection.ops.quote_name(name) for name in names]
        if connection.vendor == "postgresql":
            # CASCADE reaches what refers to accounts and is no part of a backup, such as the admin's log.
            cursor.execute(f"TRUNCATE {', '.join(quoted)} CASCADE")
            return
        for name in quoted:
            cursor.execute(f"DELETE FROM {name}")


def _tables_of_users() -> Iterator[str]:
    """Yield the tables of Django's own that refer to accounts."""
    user = LogInSession._meta.get_field("user").related_model
    for field in user._meta.many_to_many:
        yield field.remote_field.through._meta.db_table
    for relation in user._meta.related_objects:
        if relation.related_model._meta.app_label == "admin":
            yield relation.related_model._meta.db_table


def _fill(archive: zipfile.ZipFile, manifest: Manifest, say: Say) -> None:
    filled = tables()
    for table in filled:
        part = manifest.tables[table.name]
        try:
            with archive.open(f"rows/{table.name}.jsonl") as member:
                _fill_table(table, _checked_lines(member, part, table.name))
        except (KeyError, zipfile.BadZipFile, EOFError) as error:
            raise Damaged(table.name) from error
        say(f"{table.name}: {part.rows:,} rows")
    # New rows follow those that were restored.
    statements = connection.ops.sequence_reset_sql(no_style(), [table.model for table in filled])
    with connection.cursor() as cursor:
        for statement in statements:
            cursor.execute(statement)


def _checked_lines(member: IO[bytes], part: Part, name: str) -> Iterator[bytes]:
    """Yield the lines; raises Damaged after the last one where they are not those of the manifest."""
    digest, rows = sha256(), 0
    for line in member:
        digest.update(line)
        rows += 1
        yield line
    if (rows, digest.hexdigest()) != (part.rows, part.sha256):
        raise Damaged(name)


def _fill_table(table: Table, lines: Iterator[bytes]) -> None:
    rows = (table.values(line, connection) for line in lines)
    quote = connection.ops.quote_name
    columns = ", ".join(quote(name) for name in table.columns)
    target = f"{quote(table.model._meta.db_table)} ({columns})"
    with connection.cursor() as cursor:
        if connection.vendor == "postgresql":
            with cursor.copy(f"COPY {target} FROM STDIN") as copy:
                for row in rows:
                    copy.write_row(row)
            return
        places = ", ".join(["%s"] * len(table.columns))
        for some in _batches(rows):
            cursor.executemany(f"INSERT INTO {target} VALUES ({places})", some)


def _batches(rows: Iterator[list[Any]]) -> Iterator[list[list[Any]]]:
    some: list[list[Any]] = []
    for row in rows:
        some.append(row)
        if len(some) == BATCH:
            yield some
            some = []
    if some:
        yield some


def _extract(archive: zipfile.ZipFile, name: str, part: Part, staging: Path) -> None:
    """Write a file below ``staging``; never outside of it, whatever the manifest says."""
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts or path.parts[0] not in FOLDERS:
        raise Damaged(name)
    target, digest = staging / path, sha256()
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        with archive.open(f"files/{name}") as member, target.open("wb") as file:
            while data := member.read(FILE_CHUNK):
                file.write(data)
                digest.update(data)
    except (KeyError, zipfile.BadZipFile, EOFError) as error:
        raise Damaged(name) from error
    if digest.hexdigest() != part.sha256:
        raise Damaged(name)


def _move_files(staging: Path, manifest: Manifest, say: Say) -> None:
    """Put the files where they belong, as the last step of the transaction; what was there moves away."""
    moment = manifest.created_at.replace(":", "")[:17]
    for name in FOLDERS:
        here, new = settings.VAR_DIR / name, staging / name
        if here.is_dir() and any(here.iterdir()):
            aside = _free_name(settings.VAR_DIR / f"{name}-before-restoring-{moment}")
            here.rename(aside)
            say(f"What was in {here} is in {aside}.")
        if new.is_dir():
            shutil.rmtree(here, ignore_errors=True)
            new.rename(here)
    say(f"{len(manifest.files):,} files")


def _free_name(path: Path) -> Path:
    number, free = 1, path
    while free.exists():
        number += 1
        free = path.with_name(f"{path.name}-{number}")
    return free
