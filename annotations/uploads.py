"""Uploaded files, out of their archive where they came in one: bounded before anything is read."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Protocol

from django.conf import settings

from annotations.language.errors import LanguageError, Position
from annotations.language.grammar_files import TRIPLE_FILES
from annotations.language.pairs import CORPUS_FOLDERS


class Upload(Protocol):
    """What Django's uploaded files are."""

    name: str
    size: int

    def read(self) -> bytes: ...


def files_of(uploads: Iterable[Upload]) -> dict[str, bytes]:
    """Name → bytes of all uploads, zip archives unpacked (their folders are dropped).

    Raises:
        LanguageError: too much, two files of one name, or an archive that is none.
    """
    found: dict[str, bytes] = {}
    for name, data in _all(uploads):
        if name in found:
            raise LanguageError("two of the files have this name", Position(name), "rename one")
        found[name] = data
        if sum(map(len, found.values())) > settings.UPLOAD_MAX_BYTES:
            raise LanguageError(f"the files hold more than {settings.UPLOAD_MAX_BYTES:,} bytes")
    return found


@contextmanager
def unpacked_pairs(upload: Upload) -> Iterator[Path]:
    """The files of a corpus (``gen/train.txt``, ``paraphrasings.txt`` …) in a folder that is gone
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
    """Where a file of a corpus belongs; empty for any other."""
    *_, directory, name = f"//{path}".split("/")
    if name in TRIPLE_FILES:
        return name
    return f"{directory}/{name}" if directory in CORPUS_FOLDERS and name.endswith(".txt") else ""


def _file_name(path: str) -> str:
    """The name without its folders; empty for a hidden file."""
    name = path.rsplit("/", 1)[-1]
    return "" if name.startswith(".") else name


def _all(uploads: Iterable[Upload]) -> Iterator[tuple[str, bytes]]:
    for upload in uploads:
        if upload.name.lower().endswith(".zip"):
            yield from _members(upload, _file_name)
        else:
            yield upload.name, upload.read()


def _members(upload: Upload, place: Callable[[str], str]) -> Iterator[tuple[str, bytes]]:
    """The files of an archive, each where ``place`` puts it; those that it puts nowhere are left out.

    Sizes are checked as announced and again as read.
    """
    try:
        with zipfile.ZipFile(upload) as archive:
            members = [member for member in archive.infolist() if not member.is_dir()]
            _refuse_too_much(upload.name, members)
            for member in members:
                if name := place(member.filename):
                    with archive.open(member) as file:
                        yield name, file.read(settings.UPLOAD_MAX_BYTES + 1)
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, OSError) as error:
        raise LanguageError(
            "this is no zip archive that can be read",
            Position(upload.name),
            "pack the files again without a password",
        ) from error


def _refuse_too_much(name: str, members: list[zipfile.ZipInfo]) -> None:
    if len(members) > settings.UPLOAD_MAX_FILES:
        raise LanguageError(
            f"the archive holds {len(members)} files; {settings.UPLOAD_MAX_FILES} is the limit",
            Position(name),
        )
    if sum(member.file_size for member in members) > settings.UPLOAD_MAX_BYTES:
        raise LanguageError(
            f"the archive holds more than {settings.UPLOAD_MAX_BYTES:,} bytes", Position(name)
        )
