"""Verb: write a backup while the site runs."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path

from django.conf import settings
from django.db import connection
from django.utils import timezone

from annotations.language.texts import Refusal
from annotations.rows.synchronise import batches
from gpsr_site.backup.backup_manifest import NAME, BackupManifest, BackupPart, newest_migrations
from gpsr_site.backup.backup_tables import BackupTable, snapshot, tables
from gpsr_site.backup.unfit_rows import say_unfit_rows
from parser_service.models import TrainingRun

FILE_CHUNK = 1024 * 1024
LINES = 1000  # packed at once
Say = Callable[[str], None]


def write_backup(path: Path, say: Say = lambda sentence: None) -> BackupManifest:
    """Write all rows, and the files of all runs and waiting jobs, to ``path``.

    The rows are those of one moment. Nobody waits, and memory stays small however many there are. A
    checkpoint that a running run replaces meanwhile is missing; the run goes on without it.

    Raises:
        Refusal: the database lacks a migration, or ``path`` exists.
    """
    if path.exists():
        said = f"{path} exists. Choose another name, or remove it first."
        raise Refusal(said, "file_exists")
    try:
        migrations = newest_migrations()
    except Refusal as error:  # perhaps since a migration met rows that do not fit
        raise Refusal(say_unfit_rows() or error.message, error.code) from error
    manifest = BackupManifest(timezone.now().isoformat(), connection.vendor, migrations)
    unfinished = path.with_name(f".{path.name}.{os.getpid()}")
    # It holds the hashes of passwords and tokens.
    descriptor = os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with (
            os.fdopen(descriptor, "wb") as file,
            zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive,
        ):
            _write_parts(archive, manifest, say)
            archive.writestr(NAME, manifest.as_json())
        unfinished.rename(path)
    finally:
        unfinished.unlink(missing_ok=True)
    return manifest


def _write_parts(archive: zipfile.ZipFile, manifest: BackupManifest, say: Say) -> None:
    with snapshot() as using:
        for table in tables():
            manifest.tables[table.name] = part = _write_table(archive, table, using)
            say(f"{table.name}: {part.rows:,} rows")
        runs = list(TrainingRun.objects.using(using).order_by("pk").values_list("pk", flat=True))
    for path in _files(runs):
        name = path.relative_to(settings.VAR_DIR).as_posix()
        try:
            manifest.files[name] = _write_file(archive, path, name)
        except FileNotFoundError:
            manifest.missing.append(name)
    say(f"{len(manifest.files):,} files")


def _write_table(archive: zipfile.ZipFile, table: BackupTable, using: str) -> BackupPart:
    digest, n_bytes, n_rows = sha256(), 0, 0
    with archive.open(f"rows/{table.name}.jsonl", "w", force_zip64=True) as member:
        for lines in batches(table.lines(using), LINES):
            data = "".join(lines).encode()
            member.write(data)
            digest.update(data)
            n_bytes, n_rows = n_bytes + len(data), n_rows + len(lines)
    return BackupPart(n_bytes, digest.hexdigest(), n_rows)


def _write_file(archive: zipfile.ZipFile, path: Path, name: str) -> BackupPart:
    """Weights do not become smaller by packing, so they are not packed."""
    part, digest = BackupPart(0, ""), sha256()
    with path.open("rb") as file:
        entry = zipfile.ZipInfo(f"files/{name}")
        entry.compress_type = zipfile.ZIP_STORED
        with archive.open(entry, "w", force_zip64=True) as member:
            while data := file.read(FILE_CHUNK):
                member.write(data)
                digest.update(data)
                part.bytes += len(data)
    part.sha256 = digest.hexdigest()
    return part


def _files(runs: list[int]) -> Iterator[Path]:
    """Yield the files of runs, and those of jobs; what is still being written is left out."""
    for folder in [*(settings.RUNS_DIR / str(run) for run in runs), settings.VAR_DIR / "jobs"]:
        for path in sorted(folder.rglob("*")):
            is_unfinished = any(part.startswith(".") for part in path.relative_to(folder).parts)
            if path.is_file() and not path.is_symlink() and not is_unfinished:
                yield path
