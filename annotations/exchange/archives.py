"""Archives of other people: bounded before anything is read, and every defect is a sentence."""

from __future__ import annotations

import gzip
import lzma
import tarfile
import zipfile
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import count
from tempfile import TemporaryFile
from typing import IO, Any

from annotations.language.texts import LanguageError, Position, file_name

MANIFEST = "world.json"  # what the archive of a whole world says of itself
LONGEST_NAME = 200
MOST_BYTES_OF_NAME = 255  # that a folder takes
MOST_LISTED = 20_000  # members, of which most are left out
MOST_RATIO = 200  # bytes unpacked for each byte of an archive that are taken for honest
ALWAYS_ALLOWED_BYTES = 1_000_000  # so small that the ratio does not matter
MOST_UNPACKED = 200_000_000  # bytes of a packed tar archive with all that is left out of it
UTF8_NAMES = 0x800  # the flag of a zip archive that its names are UTF-8

_SUFFIXES = (".zip", ".tar", ".tar.gz", ".tgz")
_GZIP = b"\x1f\x8b"
_ARCHIVES = (b"PK\x03\x04", b"PK\x05\x06", _GZIP)
_OTHER_ARCHIVES = {b"7z\xbc\xaf": "7z", b"Rar!": "RAR", b"\xfd7zXZ": "xz", b"BZh": "bzip2"}
_OFFICE = (
    "[Content_Types].xml",
    "META-INF/manifest.xml",
)  # members of Word's, Excel's and OpenDocument's files

_UNREADABLE = (
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
    NotImplementedError,
    RuntimeError,
    EOFError,
    OSError,
    ValueError,
    KeyError,
    tarfile.TarError,
)


@dataclass(frozen=True, slots=True)
class Member:
    """A file of an archive, named as zipfile names it. ``read`` takes the most bytes that it may have."""

    filename: str
    file_size: int
    compress_size: int
    read: Callable[[int], bytes]


def is_archive(file: IO[bytes] | Any) -> bool:
    """Return whether ``file``, which has a name, is a zip or tar archive, by its first bytes or by its name.

    Raises:
        LanguageError: it is an archive of a kind that is not read.
    """
    file.seek(0)
    start = file.read(265)
    file.seek(0)
    for mark, kind in _OTHER_ARCHIVES.items():
        if start.startswith(mark):
            message = f"the file is packed with {kind}, which is not read here"
            raise LanguageError(message, Position(file.name), "pack it as .zip or .tar.gz")
    return file.name.lower().endswith(_SUFFIXES) or (
        start.startswith(_ARCHIVES) or start[257:262] == b"ustar"
    )


def open_members(file: IO[bytes] | Any, name: str, stack: ExitStack) -> Iterator[Member]:
    """Yield the files of a zip or tar archive, which stays open as long as ``stack``.

    Raises:
        LanguageError: it cannot be read, or it swells beyond all bounds.
    """
    file.seek(0)
    start = file.read(4)
    file.seek(0)
    with sentences_for(name):
        if start.startswith(b"PK") or name.lower().endswith(".zip"):
            archive = stack.enter_context(zipfile.ZipFile(file))
            if any(each in archive.NameToInfo for each in _OFFICE):
                message = "this is a Word, Excel, PowerPoint or OpenDocument file"
                hint = "save its text or sheet as plain text or CSV (UTF-8)"
                raise LanguageError(message, Position(name), hint)
            for info in archive.infolist():
                read = partial(read_member, archive, info)
                written = info.orig_filename.partition("\0")[0]
                if not info.flag_bits & UTF8_NAMES:
                    written = file_name(written.encode("cp437"))
                yield Member(written, info.file_size, info.compress_size, read)
            return
        plain = stack.enter_context(_unpack(file, name)) if start.startswith(_GZIP) else file
        tar = stack.enter_context(tarfile.open(fileobj=plain, mode="r:", errors="surrogateescape"))  # noqa: SIM115
        for member in tar:
            if member.isfile() or member.issym() or member.islnk():
                written = file_name(member.name.encode("utf-8", "surrogateescape"))
                yield Member(written, member.size, member.size, partial(_read_tar, tar, member))


def _unpack(file: IO[bytes] | Any, name: str) -> IO[bytes]:
    """Return the tar archive that ``file`` packs."""
    packed = file.seek(0, 2)
    file.seek(0)
    most = min(MOST_UNPACKED, max(ALWAYS_ALLOWED_BYTES, MOST_RATIO * packed))
    plain = TemporaryFile()  # noqa: SIM115 -- the caller closes it
    with gzip.open(file) as unpacked:
        while piece := unpacked.read(1 << 20):
            plain.write(piece)
            if plain.tell() > most:
                plain.close()
                raise _too_many_bytes(name, most)
    plain.seek(0)
    return plain


def _read_tar(archive: tarfile.TarFile, member: tarfile.TarInfo, most_bytes: int) -> bytes:
    """Return the content of a file, or the target of a link."""
    if member.issym():
        return member.linkname.encode("utf-8", "replace")
    with sentences_for(member.name):
        file = archive.extractfile(member)
        data = file.read(most_bytes + 1) if file else b""
    if len(data) > most_bytes:
        raise _too_many_bytes(member.name, most_bytes)
    return data


@contextmanager
def open_archive(
    file: IO[bytes] | Any, name: str, most_files: int, most_bytes: int
) -> Iterator[zipfile.ZipFile]:
    """Open the archive ``file`` of a world, whose list of members is within the bounds.

    Raises:
        LanguageError: it is no archive that can be read; it announces too many files, too many bytes
            or too high a ratio; or a member's name is too long.
    """
    with ExitStack() as stack:
        with sentences_for(name):
            archive = stack.enter_context(zipfile.ZipFile(file))
        members = [each for each in archive.infolist() if not each.is_dir()]
        refuse_too_much(name, members, most_files, most_bytes)
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
            "this is not an archive that can be read",
            Position(name),
            "pack the files again, as a plain .zip without a password or as .tar.gz",
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


def refuse_too_much(
    name: str, members: Sequence[zipfile.ZipInfo | Member], most_files: int, most_bytes: int
) -> None:
    """Raise LanguageError if ``members`` of ``name`` are too many or too large, unpack to far more than they hold, or
    one has too long a name."""
    place = Position(name)
    if len(members) > most_files:
        raise too_many_files(name, len(members), most_files)
    unpacked = sum(member.file_size for member in members)
    if unpacked > most_bytes:
        raise _too_many_bytes(name, most_bytes)
    packed = sum(member.compress_size for member in members)
    if unpacked > max(ALWAYS_ALLOWED_BYTES, MOST_RATIO * packed):
        raise LanguageError("the archive unpacks to far more than it holds", place, "is it a bomb?")
    for member in members:
        own_name = member.filename.replace("\\", "/").rsplit("/", 1)[-1]
        n_bytes = len(own_name.encode("utf-8", "replace"))
        if len(own_name) > LONGEST_NAME or n_bytes > MOST_BYTES_OF_NAME:
            shown = f"{member.filename[:40]}…"
            raise LanguageError(
                f"the name of the file {shown} is longer than {LONGEST_NAME} characters, or than "
                f"{MOST_BYTES_OF_NAME} bytes",
                place,
                "rename it",
            )


def too_many_files(name: str, count: int, most_files: int) -> LanguageError:
    """Return the error for an archive or a folder with too many files."""
    sentence = f"there are {count:,} files here; {most_files:,} is the limit"
    return LanguageError(sentence, Position(name), "import one folder at a time")


def _too_many_bytes(name: str, most_bytes: int) -> LanguageError:
    message = f"the files hold more than {most_bytes:,} bytes"
    return LanguageError(message, Position(name), "send fewer or smaller ones")
