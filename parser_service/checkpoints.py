"""Folders of files that are complete or absent: written beside, synchronised, renamed, hashed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path

from django.conf import settings


def run_folder(run_id: int) -> Path:
    """The folder of a run's checkpoints and model."""
    return settings.RUNS_DIR / str(run_id)


def model_folder(run_id: int) -> Path:
    """Where a succeeded run's parser was saved."""
    return run_folder(run_id) / "model"


def stored_name(folder: Path) -> str:
    """``folder`` as the database names it, below ``GPSR_VAR_DIR``, which may lie elsewhere tomorrow."""
    return folder.relative_to(settings.VAR_DIR).as_posix()


def stored_folder(name: str) -> Path:
    return settings.VAR_DIR / name


def write_folder(folder: Path, write: Callable[[Path], None]) -> str:
    """Lets ``write`` fill ``folder``, replacing what is there; the SHA-256 of the files.

    A process that is killed half-way leaves the old folder, or none, never part of one.
    """
    unfinished = folder.with_name(f".{folder.name}.{os.getpid()}")
    shutil.rmtree(unfinished, ignore_errors=True)
    unfinished.mkdir(parents=True)
    write(unfinished)
    for path in _files(unfinished):
        _synchronise(path)
    digest = digest_of(unfinished)
    shutil.rmtree(folder, ignore_errors=True)
    unfinished.rename(folder)
    _synchronise(folder.parent)
    return digest


def digest_of(folder: Path) -> str:
    """SHA-256 over the names and contents of all files in ``folder``."""
    total = sha256()
    for path in _files(folder):
        with path.open("rb") as stream:
            content = sha256()
            while block := stream.read(1 << 20):
                content.update(block)
        total.update(f"{path.relative_to(folder).as_posix()} {content.hexdigest()}\n".encode())
    return total.hexdigest()


def remove_folder(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)


def _files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _synchronise(path: Path) -> None:
    """Waits until ``path``, a file or a folder's list of names, is on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
