"""Zip archives of other people: bounded before anything is read, and every defect is a sentence."""

from __future__ import annotations

import lzma
import zipfile
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from itertools import count
from typing import IO, Any

from annotations.language.errors import LanguageError, Position

MANIFEST = "world.json"  # what the archive of a whole world says of itself
LONGEST_NAME = 200
MOST_BYTES_OF_NAME = 255  # that a folder takes
MOST_LISTED = 20_000  # members, of which most are left out
MOST_RATIO = 200  # bytes unpacked for each byte of an archive that are taken for honest
ALWAYS_ALLOWED_BYTES = 1_000_000  # so small that the ratio does not matter

_UNREADABLE = (
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
    NotImplementedError,
    RuntimeError,
    EOFError,
    OSError,
    ValueError,
)


@contextmanager
def open_archive(
    file: IO[bytes] | Any,
    name: str,
    most_files: int,
    most_bytes: int,
    is_read: Callable[[str], bool] | None = None,
) -> Iterator[zipfile.ZipFile]:
    """Open the archive ``file``, whose list of members is within the bounds.

    With ``is_read`` only the members count whose paths it takes; of the others there may be ``MOST_LISTED``.

    Raises:
        LanguageError: it is no archive that can be read; it announces too many files, too many bytes
            or too high a ratio; or a member's name is too long.
    """
    with ExitStack() as stack:
        with sentences_for(name):
            archive = stack.enter_context(zipfile.ZipFile(file))
        members = [each for each in archive.infolist() if not each.is_dir()]
        if len(members) > max(MOST_LISTED, most_files):
            raise _too_many_files(name, len(members), MOST_LISTED)
        read = [each for each in members if is_read is None or is_read(each.filename)]
        _refuse_too_much(name, read, most_files, most_bytes)
        yield archive


@contextmanager
def sentences_for(name: str) -> Iterator[None]:
    """Turn what Python says of a broken archive into a LanguageError about the file ``name``."""
    try:
        yield
    except LanguageError:
        raise
    except _UNREADABLE as error:
        raise LanguageError(
            "this is not a zip archive that can be read",
            Position(name),
            "pack the files again, as a plain zip without a password",
        ) from error


def manifests_in(archive: zipfile.ZipFile) -> list[str]:
    """Return where ``archive`` keeps the manifest of a world; nothing where it holds other files."""
    return [path for path in archive.namelist() if f"/{path}".endswith(f"/{MANIFEST}")]


def read_member(archive: zipfile.ZipFile, member: zipfile.ZipInfo, most_bytes: int) -> bytes:
    """Return the bytes of one member, whatever size it announces. Raises LanguageError above ``most_bytes``."""
    with sentences_for(member.filename), archive.open(member) as file:
        data = file.read(most_bytes + 1)
    if len(data) > most_bytes:
        raise _too_many_bytes(member.filename, most_bytes)
    return data


def read_lines(archive: zipfile.ZipFile, name: str, longest: int) -> Iterator[bytes]:
    """Yield the lines of one member, one after another. Raises LanguageError above ``longest`` bytes a line."""
    with ExitStack() as stack:
        with sentences_for(name):
            file = stack.enter_context(archive.open(name))
        for number in count(1):
            with sentences_for(name):
                line = file.readline(longest + 1)
            if len(line) > longest:
                raise LanguageError(
                    f"the line is longer than {longest:,} bytes", Position(name, number)
                )
            if not line:
                return
            yield line


def _refuse_too_much(
    name: str, members: Sequence[zipfile.ZipInfo], most_files: int, most_bytes: int
) -> None:
    place = Position(name)
    if len(members) > most_files:
        raise _too_many_files(name, len(members), most_files)
    unpacked = sum(member.file_size for member in members)
    if unpacked > most_bytes:
        raise _too_many_bytes(name, most_bytes)
    packed = sum(member.compress_size for member in members)
    if unpacked > max(ALWAYS_ALLOWED_BYTES, MOST_RATIO * packed):
        raise LanguageError("the archive unpacks to far more than it holds", place, "is it a bomb?")
    for member in members:
        own_name = member.filename.rsplit("/", 1)[-1]
        n_bytes = len(own_name.encode("utf-8", "replace"))
        if len(own_name) > LONGEST_NAME or n_bytes > MOST_BYTES_OF_NAME:
            shown = f"{member.filename[:40]}…"
            raise LanguageError(
                f"the name of the file {shown} is longer than {LONGEST_NAME} characters, or than "
                f"{MOST_BYTES_OF_NAME} bytes",
                place,
                "rename it",
            )


def _too_many_files(name: str, count: int, most_files: int) -> LanguageError:
    sentence = f"the archive holds {count:,} files; {most_files:,} is the limit"
    return LanguageError(sentence, Position(name))


def _too_many_bytes(name: str, most_bytes: int) -> LanguageError:
    return LanguageError(f"the archive holds more than {most_bytes:,} bytes", Position(name))
