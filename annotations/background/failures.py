"""What stopped a piece of work, as a sentence with what to do about it."""

from __future__ import annotations

import errno
import re
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass

from django.db import DatabaseError

from annotations.language.texts import Refusal

FULL = (errno.ENOSPC, errno.EDQUOT)
POSTGRES_FULL, SQLITE_FULL = "53100", sqlite3.SQLITE_FULL
# A disk that became read-only after an error, or a server that only replicates another.
POSTGRES_READ_ONLY, SQLITE_READ_ONLY = "25006", sqlite3.SQLITE_READONLY
# What libraries say that pass no errno on: safetensors, and the system itself.
SAYS_FULL = re.compile(
    r"no space left on device|os error 28\b|disk is full|disk quota exceeded", re.IGNORECASE
)
# A page that cannot be read: of PostgreSQL (SQLSTATE), of SQLite (the low byte of its code).
POSTGRES_DAMAGED = ("XX001", "XX002")
SQLITE_DAMAGED = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
# A table or a column that is not there: the code is newer than the database.
POSTGRES_OLDER = ("42P01", "42703")
SQLITE_OLDER = re.compile(r"no such (table|column)|has no column named")

FREE_SPACE = (
    "Free space on the disk of GPSR_VAR_DIR (its folder vectors/ is a cache and may be emptied), or on that "
    "of PostgreSQL"
)
MAKE_WRITABLE = (
    "Look why (a system makes a disk read-only after an error; the account of this site may lack the right), and "
    "make the disk of GPSR_VAR_DIR, or that of PostgreSQL, writable"
)
DAMAGED = (
    "The database is damaged: a part of it cannot be read, and what stood there may be lost. Stop the site and "
    "its workers, keep a copy of the database as it is, and bring back the last backup with “gpsr-workbench "
    "manage restore FILE --replace” (docs/guides/operations.md). What was saved after that backup is in the copy only."
)


def failure_sentence(error: Exception, noun: str = "job") -> str:
    """Say what stopped the work and what to do about it. A Refusal says both itself."""
    if trouble := disk_trouble(error):
        return f"{trouble.name}. {trouble.remedy}, then start the {noun} again."
    if is_damaged(error):
        return DAMAGED
    if isinstance(error, Refusal):
        return str(error)
    if is_out_of_memory(error):
        return f"The memory ran out. Run the {noun} on another machine, or split it up."
    return (
        f"The program has a fault ({type(error).__name__}). The worker's log shows what and where; "
        f"report it with the number of this {noun}."
    )


def file_sentence(error: OSError) -> str:
    """Say why a command could not use a file or the network, and what to do about it."""
    if trouble := disk_trouble(error):
        return f"{trouble.name} ({error.strerror}). {trouble.remedy}, then run this again."
    what = f"{error.filename} cannot be used" if error.filename else "The system refused this"
    return f"{what}: {error.strerror or type(error).__name__}. Put this right, then run it again."


def database_sentence(error: DatabaseError) -> str:
    """Say why a command could not use the database, and what to do about it."""
    if trouble := disk_trouble(error):
        return f"{trouble.name}, and the command was not finished. {trouble.remedy}, then run it again."
    if is_damaged(error):
        return DAMAGED
    cause = error.__cause__
    if getattr(cause, "sqlstate", None) in POSTGRES_OLDER or SQLITE_OLDER.search(str(error)):
        again = "Run “gpsr-workbench manage migrate”, then this again."
        return f"The database is older than this version ({error}). {again}"
    return f"The database did not carry this out ({error}). Run it again when the database answers."


def is_damaged(error: BaseException) -> bool:
    """Tell whether the database has found a part of itself that cannot be read."""
    damaged = {*POSTGRES_DAMAGED, *SQLITE_DAMAGED}
    return any(_code_of(each) in damaged for each in _with_causes(error))


@dataclass(frozen=True, slots=True)
class DiskTrouble:
    """What keeps a disk from being written; ``remedy`` begins a sentence that says what to do about it."""

    state: str
    remedy: str

    @property
    def name(self) -> str:
        return f"The disk is {self.state}"


DISK_FULL = DiskTrouble("full", FREE_SPACE)
DISK_READ_ONLY = DiskTrouble("read-only", MAKE_WRITABLE)


def disk_trouble(error: BaseException) -> DiskTrouble | None:
    """Return what keeps the disk from being written, where that is what the error means."""
    if is_disk_full(error):
        return DISK_FULL
    errors = list(_with_causes(error))
    codes = {getattr(each, "errno", None) for each in errors} | set(map(_code_of, errors))
    return DISK_READ_ONLY if codes & {errno.EROFS, POSTGRES_READ_ONLY, SQLITE_READ_ONLY} else None


def is_disk_full(error: BaseException) -> bool:
    """Tell whether the error means a full disk, in any form in which libraries say so.

    A database says it by its code. Its words may be those of a row.
    """
    errors = list(_with_causes(error))
    if any(getattr(each, "errno", None) in FULL for each in errors):
        return True
    if codes := [code for each in errors if (code := _code_of(each))]:
        return POSTGRES_FULL in codes or SQLITE_FULL in codes
    return any(SAYS_FULL.search(str(each)) for each in errors)


def _code_of(error: BaseException) -> str | int | None:
    """Return the code of an error of PostgreSQL (SQLSTATE) or SQLite (the low byte); None for any other."""
    sqlite_code = getattr(error, "sqlite_errorcode", None)
    return getattr(error, "sqlstate", None) or (sqlite_code and sqlite_code & 0xFF)


def _with_causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__


def is_out_of_memory(error: Exception) -> bool:
    """Tell whether the memory of the machine or of the GPU ran out."""
    return isinstance(error, MemoryError) or type(error).__name__ == "OutOfMemoryError"
