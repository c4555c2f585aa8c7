"""Folders of files that are complete or absent: written beside, synchronised, renamed, hashed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path

from django.conf import settings

from parser_service.parsers.storage import file_hash


def run_folder(run_id: int) -> Path:
    """Return the folder of a run's checkpoints and model."""
    return settings.RUNS_DIR / str(run_id)


def model_folder(run_id: int) -> Path:
    """Return the folder that holds the parser of a run that succeeded."""
    return run_folder(run_id) / "model"


def stored_name(folder: Path) -> str:
    """Return the name of ``folder`` relative to ``GPSR_VAR_DIR``, so that the latter can be moved."""
    return folder.relative_to(settings.VAR_DIR).as_posix()


def stored_folder(name: str) -> Path:
    """Return the folder that ``stored_name`` named."""
    return settings.VAR_DIR / name


def write_folder(folder: Path, write: Callable[[Path], None]) -> str:
    """Let ``write`` fill ``folder``, replacing what is there. Return the SHA-256 of the files.

    A process that is killed half-way leaves the old folder, or none, never part of one; what an error
    leaves unfinished is removed.
    """
    unfinished = folder.with_name(f".{folder.name}.{os.getpid()}")
    shutil.rmtree(unfinished, ignore_errors=True)
    try:
        unfinished.mkdir(parents=True)
        write(unfinished)
        for path in _files(unfinished):
            _synchronise(path)
        digest = digest_of(unfinished)
        shutil.rmtree(folder, ignore_errors=True)
        unfinished.rename(folder)
    except BaseException:
        shutil.rmtree(unfinished, ignore_errors=True)
        raise
    _synchronise(folder.parent)
    return digest


def digest_of(folder: Path) -> str:
    """Return the SHA-256 over the names and contents of all files in ``folder``."""
    total = sha256()
    for path in _files(folder):
        total.update(f"{path.relative_to(folder).as_posix()} {file_hash(path)}\n".encode())
    return total.hexdigest()


def remove_folder(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)


def _files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _synchronise(path: Path) -> None:
    """Wait until ``path``, a file or a folder's list of names, is on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
