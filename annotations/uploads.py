"""Uploaded files, out of their archive where they came in one: bounded before anything is read."""

from __future__ import annotations

import zipfile
from collections.abc import Iterable, Iterator
from typing import Protocol

from django.conf import settings

from annotations.language.errors import LanguageError, Position


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


def _all(uploads: Iterable[Upload]) -> Iterator[tuple[str, bytes]]:
    for upload in uploads:
        if upload.name.lower().endswith(".zip"):
            yield from _members(upload)
        else:
            yield upload.name, upload.read()


def _members(upload: Upload) -> Iterator[tuple[str, bytes]]:
    """The files of an archive. Sizes are checked as announced and again as read."""
    try:
        with zipfile.ZipFile(upload) as archive:
            members = [member for member in archive.infolist() if not member.is_dir()]
            _refuse_too_much(upload.name, members)
            for member in members:
                name = member.filename.rsplit("/", 1)[-1]
                if not name.startswith("."):
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
