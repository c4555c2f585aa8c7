"""The uploads of a job, kept under ``var/jobs/ID/`` until it has ended, and the file that it made."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from secrets import token_hex
from typing import IO, TYPE_CHECKING, Any

from django.conf import settings
from django.core.files.base import File

from annotations.models import Job


def folder_of(job: Job) -> Path:
    """Return where the uploads of ``job`` lie, named by their numbers."""
    return jobs_folder() / str(job.pk)


def jobs_folder() -> Path:
    return settings.VAR_DIR / "jobs"


def results_folder() -> Path:
    return settings.VAR_DIR / "results"


def result_of(job: Job) -> Path:
    """Return where the file stands that ``job`` has made, if it makes one."""
    return results_folder() / f"{job.pk}.jsonl"


def keep_uploads(uploads: Sequence[Any]) -> Path:
    """Copy uploads, in pieces, into a new folder that belongs to no job yet."""
    folder = jobs_folder() / f"incoming-{token_hex(8)}"
    folder.mkdir(parents=True, mode=0o700)
    for number, upload in enumerate(uploads):
        upload.seek(0)
        with (folder / str(number)).open("wb") as target:
            shutil.copyfileobj(upload, target)
    return folder


if TYPE_CHECKING:

    class KeptUpload(File[bytes]):
        """An upload, which has a name and a size."""

        name: str
        size: int
else:
    KeptUpload = File


@contextmanager
def kept_uploads(job: Job) -> Iterator[list[KeptUpload]]:
    """Open the uploads of ``job``, under the names that they came with."""
    names = job.arguments.get("files", [])
    with ExitStack() as stack:
        opened: Iterable[IO[bytes]] = (
            stack.enter_context((folder_of(job) / str(number)).open("rb"))
            for number in range(len(names))
        )
        yield [KeptUpload(file, name) for file, name in zip(opened, names, strict=True)]


def forget_files(job: Job) -> None:
    """Remove what was kept for ``job``."""
    shutil.rmtree(folder_of(job), ignore_errors=True)
