"""Uploaded files, out of their archive where they came in one: bounded before anything is read."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from posixpath import commonpath, dirname, join, normpath
from tempfile import TemporaryDirectory
from typing import Protocol

from django.conf import settings

from annotations.importing.gathered_files import GatheredFiles, convert, flatten, is_generator_path
from annotations.importing.pair_files import Notation, is_table
from annotations.importing.zip_archives import LONGEST_NAME, manifests_in, open_archive, read_member
from annotations.language.corpus import (
    CORPUS_FOLDERS,
    foreign_part,
    is_corpus_path,
)
from annotations.language.decoding import link_target
from annotations.language.errors import LanguageError, Position
from annotations.language.grammar import TRIPLE_FILES
from annotations.language.ontology import place_in_folder

GENERATOR_FOLDER = "generator/"
_TWICE = "two of the files have this name"


class UploadedFile(Protocol):
    """What Django's uploaded files are."""

    name: str
    size: int

    def read(self, size: int = -1, /) -> bytes: ...

    def seek(self, offset: int, whence: int = 0, /) -> int: ...


def files_of(uploads: Iterable[UploadedFile], encoding: str = "") -> GatheredFiles:
    """Return the files of all uploads, zip archives unpacked and their folders dropped (``flatten``).

    Of the archive of a whole world only the files of its generator are taken. ``encoding`` is that of files
    that are not UTF-8 (``convert``).

    Raises:
        LanguageError: too much, two files of one name and place, or an archive that cannot be read.
    """
    files: dict[str, bytes] = {}
    size = 0
    for path, data in _all(uploads):
        if path in files:
            raise LanguageError(_TWICE, Position(path), "rename one")
        files[path] = data
        size += len(data)
        if size > settings.UPLOAD_MAX_BYTES:
            raise LanguageError(f"the files hold more than {settings.UPLOAD_MAX_BYTES:,} bytes")
    return convert(flatten(files), encoding)


def competition_files_of(uploads: Iterable[UploadedFile]) -> dict[str, bytes]:
    """Return the files of a competition's folder in all uploads, zip archives unpacked: path → bytes.

    Raises:
        LanguageError: as ``files_of``.
    """
    files: dict[str, bytes] = {}
    for upload in uploads:
        if not is_archive(upload):
            upload.seek(0)
            files[upload.name] = upload.read()
            continue
        with _open(
            upload, lambda path: bool(_visible_path(path) and place_in_folder(path))
        ) as archive:
            for member in archive.infolist():
                path = member.filename
                if not member.is_dir() and _visible_path(path) and place_in_folder(path):
                    files[path] = read_member(archive, member, settings.UPLOAD_MAX_BYTES)
    return files


def unpacked_size(uploads: Iterable[UploadedFile]) -> int:
    """Return how many bytes the uploads hold, as their archives announce it; nothing is unpacked.

    Raises:
        LanguageError: an archive that cannot be read.
    """
    total = 0
    for upload in uploads:
        if is_archive(upload):
            with _open(upload, _may_be_read) as archive:
                total += sum(
                    member.file_size
                    for member in archive.infolist()
                    if _may_be_read(member.filename)
                )
        else:
            total += upload.size
    return total


def _may_be_read(path: str) -> bool:
    """Return whether some import reads a file with this path."""
    return bool(_visible_path(path)) and (
        is_generator_path(path) or bool(_place_of_pairs(path) or _name_alone(path))
    )


def is_archive(upload: UploadedFile) -> bool:
    return upload.name.lower().endswith(".zip")


@contextmanager
def unpacked_pairs(upload: UploadedFile, notation: str = Notation.OURS) -> Iterator[Path]:
    """Unpack the files of a corpus (``gen/train.txt``, ``paraphrasings.txt`` …) into a temporary folder.

    Other files of the archive, and the folders around, are left out. Sizes are checked as announced and as read.

    Raises:
        LanguageError: as ``files_of``.
    """
    with TemporaryDirectory(prefix="gpsr-pairs-") as folder:
        place = _name_alone if notation == Notation.LAMBDA else _place_of_pairs
        with _open(upload, lambda path: bool(place(path))) as archive:
            for member in archive.infolist():
                path = "" if member.is_dir() else place(member.filename)
                if not path:
                    continue
                data = read_member(archive, member, settings.UPLOAD_MAX_BYTES)
                target = Path(folder, path)
                if target.exists() and target.read_bytes() != data:
                    raise LanguageError(_TWICE, Position(path), "rename one")
                target.parent.mkdir(exist_ok=True)
                target.write_bytes(data)
        yield Path(folder)


def _place_of_pairs(path: str) -> str:
    """Return where a file of a corpus belongs; empty for any other."""
    *_, directory, name = f"//{path}".split("/")
    if name.lower() in TRIPLE_FILES or is_table(name):
        return name
    is_corpus = directory.lower() in CORPUS_FOLDERS and name.lower().endswith(".txt")
    return f"{directory}/{name}" if is_corpus else ""


def _name_alone(path: str) -> str:
    """Return where a file of another corpus belongs, beside the others; empty for any other."""
    name = _visible_path(path).rsplit("/", 1)[-1]
    return name if foreign_part(name) else ""


def _visible_path(path: str) -> str:
    """Return the path; empty for a hidden file."""
    parts = path.split("/")
    return "" if any(part.startswith(".") and part not in (".", "..") for part in parts) else path


def _all(uploads: Iterable[UploadedFile]) -> Iterator[tuple[str, bytes]]:
    for upload in uploads:
        if is_archive(upload):
            yield from _generator_files(upload)
        else:
            if len(upload.name) > LONGEST_NAME:
                raise LanguageError(
                    f"a file name is longer than {LONGEST_NAME} characters",
                    Position(f"{upload.name[:40]}…"),
                    "rename the file",
                )
            upload.seek(0)
            yield upload.name, upload.read()


def _generator_files(upload: UploadedFile) -> Iterator[tuple[str, bytes]]:
    """Yield the files of an archive that may be of a generator, and what their links lead to: path → bytes.

    Of other files only those beside the topmost folders are named, as an import of a directory does.
    """
    with _open(upload, _may_be_read) as archive:
        is_of_world = bool(manifests_in(archive))
        members = {
            each.filename: each
            for each in archive.infolist()
            if not each.is_dir()
            and _visible_path(each.filename)
            and (not is_of_world or f"/{GENERATOR_FOLDER}" in f"/{each.filename}")
        }
        folders = {path: dirname(f"/{path}") for path in members}  # some begin with a slash
        top = commonpath(list(folders.values())) if members else ""
        waiting = [path for path in members if is_generator_path(path) or is_corpus_path(path)]
        taken = set(waiting)
        for path in waiting:
            data = read_member(archive, members[path], settings.UPLOAD_MAX_BYTES)
            yield path, data
            target = link_target(data, path)
            behind = normpath(join(dirname(path), target)) if target else ""
            if behind in members and behind not in taken:
                taken.add(behind)
                waiting.append(behind)
        yield from ((path, b"") for path in members if path not in taken and folders[path] == top)


@contextmanager
def _open(upload: UploadedFile, is_read: Callable[[str], bool]) -> Iterator[zipfile.ZipFile]:
    bounds = settings.UPLOAD_MAX_FILES, settings.UPLOAD_MAX_BYTES
    upload.seek(0)
    with open_archive(upload, upload.name, *bounds, is_read) as archive:
        yield archive
