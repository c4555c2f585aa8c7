"""Files that their owner alone may read, whatever the folder around them allows."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path


def make_private(path: Path) -> None:
    """Create an empty file with mode 0600, or take the access of others from an existing one."""
    with contextlib.suppress(FileExistsError):
        os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
    if path.stat().st_mode & 0o077:
        with contextlib.suppress(PermissionError):  # another account's file
            path.chmod(0o600)


def make_database_private(path: Path) -> None:
    """Let only the owner read the database; SQLite gives its ``-wal`` and ``-shm`` files the same mode."""
    make_private(path)
    for suffix in ("-wal", "-shm"):
        beside = path.with_name(path.name + suffix)
        with contextlib.suppress(FileNotFoundError):
            beside.stat()
            make_private(beside)
