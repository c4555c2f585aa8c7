"""Files that their owner alone may read, whatever the folder around them allows, and the secret keys in them."""

from __future__ import annotations

import contextlib
import os
import secrets
import time
from pathlib import Path

from django.core.exceptions import ImproperlyConfigured

PATIENCE_SECONDS = 5.0  # with another process that starts at the same moment and makes the key


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


def read_or_make_secret_key(path: Path) -> str:
    """Return the key in ``path``. If the file does not exist, write a new key to it with mode 0600.

    Raises ImproperlyConfigured where the file stays empty.
    """
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        deadline = time.monotonic() + PATIENCE_SECONDS
        while not (key := path.read_text(encoding="ascii").strip()):  # somebody else writes it now
            if time.monotonic() > deadline:
                said = f"{path} is empty. Delete it, and a new key is made."
                raise ImproperlyConfigured(said) from None
            time.sleep(0.01)
        return key
    key = secrets.token_urlsafe(48)
    with os.fdopen(descriptor, "w", encoding="ascii") as file:
        file.write(key)
    return key
