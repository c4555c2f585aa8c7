"""Verb: make an installation from a backup."""

from __future__ import annotations

import lzma
import shutil
import zipfile
import zlib
from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path, PurePosixPath
from typing import IO

from django.conf import settings
from django.core.management.color import no_style
from django.db import DataError, IntegrityError, connection, transaction

from annotations.language.texts import Refusal
from annotations.models import LogInSession, User
from annotations.rows.synchronise import batches
from gpsr_site.backup.backup_manifest import (
    BackupManifest,
    BackupPart,
    newest_migrations,
    read_manifest,
)
from gpsr_site.backup.backup_tables import BackupTable, tables

FOLDERS = ("runs", "jobs")
FILE_CHUNK = 1024 * 1024
# What Python says of a member that is missing, cut off, locked, or packed in a way that it does not know.
UNREADABLE = (
    *(KeyError, zipfile.BadZipFile, EOFError, NotImplementedError, RuntimeError),
    *(zlib.error, lzma.LZMAError),
)
BATCH = 2000
Say = Callable[[str], None]


class Damaged(Refusal):
    """A part of the backup is not what its manifest says."""

    code = "backup_damaged"

    def __init__(self, name: str) -> None:
        super().__init__(
            f"{name} was changed or damaged after the backup was written. Nothing was restored."
        )


def restore(path: Path, replace: bool = False, say: Say = lambda sentence: None) -> BackupManifest:
    """Fill this installation from the backup at ``path``: all of it, or nothing.

    With ``replace`` the rows that are here are deleted, and the files put into a folder beside.

    Raises:
        Refusal: the file is no backup, is damaged, is of another version, or this installation
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
        said = f"{path} cannot be read as a backup: it is no zip archive, or only a part of one."
        raise Refusal(said, "no_backup") from error
    finally:
        shutil.rmtree(staging, ignore_errors=True)
    return manifest


def _refuse_other_versions(manifest: BackupManifest) -> None:
    here = newest_migrations()
    for app, name in here.items():
        if (there := manifest.migrations.get(app)) != name:
            raise Refusal(
                f"The backup is of the version whose newest migration of {app} is {there}; here it is "
                f"{name}. Install that version, restore, then upgrade.",
                "other_version",
            )
    if set(manifest.tables) != {table.name for table in tables()}:
        raise Refusal(
            "The backup has other tables than this installation. Single sign-on has to be set up in "
            "both, or in neither.",
            "other_tables",
        )


def _refuse_to_overwrite() -> None:
    for table in tables():
        if table.model._base_manager.exists():
            raise Refusal(
                f"This installation is not empty: it has rows of {table.name}. Restore into an empty "
                "one, or give --replace, which deletes everything that is here.",
                "not_empty",
            )
    if settings.RUNS_DIR.is_dir() and any(settings.RUNS_DIR.iterdir()):
        said = f"{settings.RUNS_DIR} holds runs of another database. Move it away first."
        raise Refusal(said, "not_empty")


def _empty() -> None:
    """Delete all rows. The constraints between them are looked at when the transaction ends."""
    with connection.cursor() as cursor:
        names = [table.model._meta.db_table for table in tables()]
        names.append(LogInSession._meta.db_table)
        # Django's tables that refer to accounts.
        many = [field.remote_field.through for field in User._meta.many_to_many]
        referring = [each for each in many if each is not None]
        others = [relation.related_model for relation in User._meta.related_objects]
        referring += [each for each in others if each._meta.app_label == "admin"]
        names += [each._meta.db_table for each in referring]
        quoted = [connection.ops.quote_name(name) for name in names]
        if connection.vendor == "postgresql":
            # CASCADE reaches what refers to accounts and is no part of a backup, such as the admin's log.
            cursor.execute(f"TRUNCATE {', '.join(quoted)} CASCADE")
            return
        for name in quoted:
            cursor.execute(f"DELETE FROM {name}")


def _fill(archive: zipfile.ZipFile, manifest: BackupManifest, say: Say) -> None:
    filled = tables()
    for table in filled:
        part = manifest.tables[table.name]
        try:
            with archive.open(f"rows/{table.name}.jsonl") as member:
                _fill_table(table, _checked_lines(member, part, table.name))
        except UNREADABLE as error:
            raise Damaged(table.name) from error
        except (IntegrityError, DataError) as error:
            said = (
                f"{table.name}: its rows do not fit together; one names a row that is not there, or is "
                "there twice. Nothing was restored."
            )
            raise Refusal(said, "rows_do_not_fit") from error
        say(f"{table.name}: {part.rows:,} rows")
    # New rows follow those that were restored.
    statements = connection.ops.sequence_reset_sql(no_style(), [table.model for table in filled])
    with connection.cursor() as cursor:
        for statement in statements:
            cursor.execute(statement)


def _checked_lines(member: IO[bytes], part: BackupPart, name: str) -> Iterator[bytes]:
    """Yield the lines; raises Damaged after the last one where they are not those of the manifest."""
    digest, rows = sha256(), 0
    for line in member:
        digest.update(line)
        rows += 1
        yield line
    if (rows, digest.hexdigest()) != (part.rows, part.sha256):
        raise Damaged(name)


def _fill_table(table: BackupTable, lines: Iterator[bytes]) -> None:
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
        for some in batches(rows, BATCH):
            cursor.executemany(f"INSERT INTO {target} VALUES ({places})", some)


def _extract(archive: zipfile.ZipFile, name: str, part: BackupPart, staging: Path) -> None:
    """Write a file below ``staging``; never outside of it, whatever the manifest says."""
    path = PurePosixPath(name)
    is_inside = path.parts[:1] in [(folder,) for folder in FOLDERS] and ".." not in path.parts
    if not is_inside or not name.isprintable():
        raise Damaged(name)
    target, digest = staging / path, sha256()
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        with archive.open(f"files/{name}") as member, target.open("wb") as file:
            while data := member.read(FILE_CHUNK):
                file.write(data)
                digest.update(data)
    except UNREADABLE as error:
        raise Damaged(name) from error
    if digest.hexdigest() != part.sha256:
        raise Damaged(name)


def _move_files(staging: Path, manifest: BackupManifest, say: Say) -> None:
    """Put the files where they belong, as the last step of the transaction; what was there moves away."""
    moment = manifest.created_at.replace(":", "")[:17]
    for name in FOLDERS:
        here, new = settings.VAR_DIR / name, staging / name
        if here.is_dir() and any(here.iterdir()):
            first = aside = settings.VAR_DIR / f"{name}-before-restoring-{moment}"
            number = 1
            while aside.exists():
                number += 1
                aside = first.with_name(f"{first.name}-{number}")
            here.rename(aside)
            say(f"What was in {here} is in {aside}.")
        if new.is_dir():
            shutil.rmtree(here, ignore_errors=True)
            new.rename(here)
    say(f"{len(manifest.files):,} files")
