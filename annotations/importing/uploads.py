"""Uploaded files, out of their archive where they came in one: bounded before anything is read."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Protocol

from django.conf import settings

from annotations.importing.archives import LONGEST_NAME, manifests_in, open_archive, read_member
from annotations.language.corpus import CORPUS_FOLDERS
from annotations.language.errors import LanguageError, Position
from annotations.language.grammar import TRIPLE_FILES

GENERATOR_FOLDER = "generator/"


class Upload(Protocol):
    """What Django's uploaded files are."""

    name: str
    size: int

    def read(self, size: int = -1, /) -> bytes: ...

    def seek(self, offset: int, whence: int = 0, /) -> int: ...


def files_of(uploads: Iterable[Upload]) -> dict[str, bytes]:
    """Return name → bytes of all uploads, zip archives unpacked (their folders are dropped).

    Of the archive of a whole world only the files of its generator are taken.

    Raises:
        LanguageError: too much, two files of one name, or an archive that cannot be read.
    """
    files: dict[str, bytes] = {}
    for name, data in _all(uploads):
        if name in files:
            raise LanguageError("two of the files have this name", Position(name), "rename one")
        files[name] = data
        if sum(map(len, files.values())) > settings.UPLOAD_MAX_BYTES:
            raise LanguageError(f"the files hold more than {settings.UPLOAD_MAX_BYTES:,} bytes")
    return files


def unpacked_size(uploads: Iterable[Upload]) -> int:
    """Return how many bytes the uploads hold, as their archives announce it; nothing is unpacked.

    Raises:
        LanguageError: an archive that cannot be read.
    """
    total = 0
    for upload in uploads:
        if is_archive(upload):
            with _open(upload) as archive:
                total += sum(member.file_size for member in archive.infolist())
        else:
            total += upload.size
    return total


def is_archive(upload: Upload) -> bool:
    return upload.name.lower().endswith(".zip")


@contextmanager
def unpacked_pairs(upload: Upload) -> Iterator[Path]:
    """Unpack the files of a corpus (``gen/train.txt``, ``paraphrasings.txt`` …) in a folder that is gone
    afterwards. Whatever else the archive holds, and the folders around them, is left out.

    Raises:
        LanguageError: as ``files_of``.
    """
    with TemporaryDirectory(prefix="gpsr-pairs-") as folder:
        for path, data in _members(upload, _place_of_pairs):
            target = Path(folder, path)
            target.parent.mkdir(exist_ok=True)
            target.write_bytes(data)
        yield Path(folder)


def _place_of_pairs(path: str) -> str:
    """Return where a file of a corpus belongs; empty for any other."""
    *_, directory, name = f"//{path}".split("/")
    if name in TRIPLE_FILES:
        return name
    return f"{directory}/{name}" if directory in CORPUS_FOLDERS and name.endswith(".txt") else ""


def _file_name(path: str) -> str:
    """Return the name without its folders; empty for a hidden file."""
    name = path.rsplit("/", 1)[-1]
    return "" if name.startswith(".") else name


def _generator_file_name(path: str) -> str:
    """Do as ``_file_name``, for the files of the generator inside the archive of a world."""
    return _file_name(path) if f"/{GENERATOR_FOLDER}" in f"/{path}" else ""


def _all(uploads: Iterable[Upload]) -> Iterator[tuple[str, bytes]]:
    for upload in uploads:
        if is_archive(upload):
            yield from _members(upload, _file_name)
        else:
            if len(upload.name) > LONGEST_NAME:
                raise LanguageError(
                    f"a file name is longer than {LONGEST_NAME} characters",
                    Position(f"{upload.name[:40]}…"),
                    "rename the file",
                )
            upload.seek(0)
            yield upload.name, upload.read()


def _members(upload: Upload, place: Callable[[str], str]) -> Iterator[tuple[str, bytes]]:
    """Yield the files of an archive, each where ``place`` puts it; those that it puts nowhere are left out.

    Sizes are checked as announced and again as read.
    """
    with _open(upload) as archive:
        if place is _file_name and manifests_in(archive):
            place = _generator_file_name
        for member in archive.infolist():
            name = "" if member.is_dir() else place(member.filename)
            if name:
                yield name, read_member(archive, member, settings.UPLOAD_MAX_BYTES)


@contextmanager
def _open(upload: Upload) -> Iterator[zipfile.ZipFile]:
    bounds = settings.UPLOAD_MAX_FILES, settings.UPLOAD_MAX_BYTES
    upload.seek(0)
    with open_archive(upload, upload.name, *bounds) as archive:
        yield archive
