"""What stopped a piece of work, as a sentence with what to do about it."""

from __future__ import annotations

import errno
import re
from collections.abc import Iterator

FULL = (errno.ENOSPC, errno.EDQUOT)
POSTGRES_FULL = "53100"
# What libraries say that pass no errno on: safetensors, SQLite, PostgreSQL, and the system itself.
SAYS_FULL = re.compile(
    r"no space left on device|os error 28\b|disk is full|disk quota exceeded", re.IGNORECASE
)


def failure_sentence(error: Exception, noun: str = "job") -> str:
    """Say what stopped the work and what to do about it. A ValueError of ours says both itself."""
    if is_disk_full(error):
        return (
            "The disk is full. Free space on the disk of GPSR_VAR_DIR (its folder vectors/ is a cache "
            f"and may be emptied), then start the {noun} again."
        )
    if isinstance(error, ValueError):
        return str(error)
    if is_out_of_memory(error):
        return f"The memory ran out. Run the {noun} on another machine, or split it up."
    return (
        f"The program has a fault: {type(error).__name__}: {error}. The worker's log shows where; "
        f"report it with the number of this {noun}."
    )


def is_disk_full(error: BaseException) -> bool:
    """Tell whether the error means a full disk, in any form in which libraries say so."""
    return any(
        getattr(each, "errno", None) in FULL
        or getattr(each, "sqlstate", None) == POSTGRES_FULL
        or SAYS_FULL.search(str(each))
        for each in _with_causes(error)
    )


def _with_causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__


def is_out_of_memory(error: Exception) -> bool:
    """Tell whether the memory of the machine or of the GPU ran out."""
    return isinstance(error, MemoryError) or type(error).__name__ == "OutOfMemoryError"
