"""The files that an import reads: of a folder, of archives or of an upload, under one set of rules.

A path has ``/`` between its folders whatever system wrote it, composed letters, and no drive, leading slash or ``..``.
Hidden files, and what macOS and Windows put beside files, are left out. Counts and sizes are bounded before anything is
unpacked. Links are followed where they lead to a file of the same source.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from posixpath import dirname, join, normpath
from typing import Any, Protocol

from django.conf import settings

from annotations.exchange.archives import (
    MANIFEST,
    MOST_LISTED,
    Member,
    is_archive,
    open_members,
    refuse_too_much,
    too_many_files,
)
from annotations.language.texts import (
    MAX_LINKS,
    LanguageError,
    Position,
    Problem,
    error_at,
    file_name,
    link_target,
    normalise_record,
    read_file,
    walk_folder,
    warning_at,
)

GENERATOR_FOLDER = "generator/"  # of the archive of a whole world
_NEVER_READ = {"__macosx", "thumbs.db", "desktop.ini"}
_DRIVE = re.compile(r"[A-Za-z]:")


class UploadedFile(Protocol):
    """What Django's uploaded files are. One of a folder has its path there as ``sent_path``."""

    name: str
    size: int

    def read(self, size: int = -1, /) -> bytes: ...

    def seek(self, offset: int, whence: int = 0, /) -> int: ...


# A folder or an archive on this machine, files that were sent, or path → content.
FileSource = Path | str | Iterable[UploadedFile] | Mapping[str, bytes]


@dataclass(frozen=True)
class GatheredFiles:
    """The files that an import reads, by path; ``others`` are the paths beside them that it does not read."""

    files: Mapping[str, bytes]
    problems: tuple[Problem, ...] = ()
    others: tuple[str, ...] = ()


def path_of(upload: UploadedFile) -> str:
    """Return the path of a file in the folder that was sent; its name where it was sent alone."""
    return str(getattr(upload, "sent_path", "") or upload.name)


def read_files(
    source: FileSource, is_wanted: Callable[[str], bool], most_bytes: int | None = None
) -> GatheredFiles:
    """Return the files of ``source`` whose paths ``is_wanted``. Of the archive of a world only its generator counts.

    Args:
        most_bytes: of all of them together; ``UPLOAD_MAX_BYTES`` if it is not given.

    Raises:
        LanguageError: there is no such folder, an archive cannot be read, or there is too much. What is wrong with
            one file of a folder is among the problems instead.
    """
    most_bytes = most_bytes or settings.UPLOAD_MAX_BYTES
    problems: list[Problem] = []
    with ExitStack() as stack:
        found: dict[str, list[Member]] = {}
        name = Path(source).name if isinstance(source, Path | str) else ""
        for count, member in enumerate(_members(source, stack, most_bytes, problems), start=1):
            if count > MOST_LISTED:
                raise too_many_files(name, count, MOST_LISTED)
            if path := clean_path(member.filename):
                found.setdefault(path, []).append(member)
        if any(f"/{path}".endswith(f"/{MANIFEST}") for path in found):
            found = {path: at for path, at in found.items() if f"/{GENERATOR_FOLDER}" in f"/{path}"}
        wanted = [path for path in found if is_wanted(path)]
        members = [member for path in wanted for member in found[path]]
        refuse_too_much(name, members, settings.UPLOAD_MAX_FILES, most_bytes)
        reading = _Reading(found, most_bytes, is_folder=name != "" and Path(source).is_dir())  # type: ignore[arg-type]
        files = {path: data for path in wanted if (data := reading.read(path)) is not None}
    others = tuple(path for path in found if not is_wanted(path))
    return GatheredFiles(files, (*problems, *reading.problems), others)


def read_one_file(upload: UploadedFile, is_wanted: Callable[[str], bool], most_bytes: int) -> bytes:
    """Return the content of a file, or of the only wanted one in an archive.

    Raises:
        LanguageError: it is too large, or an archive without one such file.
    """
    if not is_archive(upload):
        refuse_too_much(upload.name, [_member_of(upload)], 1, most_bytes)
        return _content(upload, most_bytes)
    gathered = read_files([upload], is_wanted, most_bytes)
    if len(gathered.files) != 1:
        names = ", ".join(sorted(gathered.files)[:5]) or "none"
        message = f"an archive with one file that can be read is taken here; in this one: {names}"
        raise LanguageError(message, Position(upload.name), "pack one file, or send it unpacked")
    return next(iter(gathered.files.values()))


def clean_path(written: str) -> str:
    """Return a path by the rules of this module; empty for a folder and for what is never read."""
    written = written.replace("\\", "/")
    parts = [normalise_record(part) for part in written.split("/") if part not in ("", ".", "..")]
    if parts and _DRIVE.fullmatch(parts[0]):
        del parts[0]
    is_left_out = any(part[:1] == "." or part.casefold() in _NEVER_READ for part in parts)
    return "" if is_left_out or written.endswith("/") else "/".join(parts)


def by_place(
    gathered: GatheredFiles,
    place_of: Callable[[str], str],
    may_differ: Callable[[bytes, str], bool] = lambda data, path: False,
) -> GatheredFiles:
    """Return the files by their places, which are compared in any case of letters.

    Of several files with one place the one nearest to the top is taken. Another one there with other content is an
    error, unless all of them ``may_differ``; one further down is left out, with a warning.
    """
    problems = list(gathered.problems)
    groups: dict[str, list[str]] = {}
    for path in sorted(gathered.files, key=lambda path: (path.count("/"), path)):
        groups.setdefault(place_of(path).lower(), []).append(path)
    files: dict[str, bytes] = {}
    for first, *others in groups.values():
        data = files[place_of(first)] = gathered.files[first]
        different = [path for path in others if gathered.files[path] != data]
        if may_differ(data, first):
            different = [path for path in different if not may_differ(gathered.files[path], path)]
        for path in different:
            if path.count("/") > first.count("/"):
                sentence = f"{first} has this name too, and is nearer to the top; left out"
                problems.append(warning_at(Position(path), sentence, "import one folder at a time"))
            else:
                sentence = f"two of the files have this name; the other is {first}"
                problems.append(error_at(Position(path), sentence, "rename one"))
    return GatheredFiles(files, tuple(problems), gathered.others)


class _Reading:
    """Reads the members that were found, following links. Content is bounded as it is read, too."""

    def __init__(self, found: Mapping[str, list[Member]], most_bytes: int, is_folder: bool) -> None:
        self.problems: list[Problem] = []
        self._found, self._left, self._is_folder = found, most_bytes, is_folder

    def read(self, path: str) -> bytes | None:
        """Return the content at ``path``; None, with a problem, where it cannot be read."""
        at = path
        try:
            for _ in range(MAX_LINKS):
                if at not in self._found:
                    break
                data = self._content(at)
                target = link_target(data, at)
                if target is None:
                    self._left -= len(data)
                    return data
                at = normpath(join(dirname(at), target))
        except LanguageError as error:
            if not self._is_folder:
                raise
            self.problems.append(error.problem)
            return None
        hint = "send that file as well, or the file itself in the place of the link"
        sentence = f"this is a link to {at}, which is not here"
        self.problems.append(error_at(Position(path), sentence, hint))
        return None

    def _content(self, path: str) -> bytes:
        first, *others = (member.read(self._left) for member in self._found[path])
        if any(other != first for other in others):
            raise LanguageError("two of the files have this name", Position(path), "rename one")
        return first


def _members(
    source: FileSource, stack: ExitStack, most_bytes: int, problems: list[Problem]
) -> Iterator[Member]:
    if isinstance(source, Mapping):
        for path, data in source.items():
            yield Member(path, len(data), len(data), partial(_piece, data))
    elif not isinstance(source, Path | str):
        for upload in source:
            upload.seek(0)
            if is_archive(upload):
                yield from open_members(upload, upload.name, stack)
            else:
                yield _member_of(upload)
    elif Path(source).is_file():
        file = stack.enter_context(Path(source).open("rb"))  # noqa: SIM115
        yield from open_members(file, Path(source).name, stack)
    else:
        folder = Path(source)
        for path in walk_folder(folder, problems):
            size = path.stat().st_size if path.exists() else 0
            written = file_name(os.fsencode(path.relative_to(folder)))
            yield Member(written, size, size, partial(read_file, path, folder))


def _member_of(upload: UploadedFile) -> Member:
    return Member(path_of(upload), upload.size, upload.size, partial(_content, upload))


def _piece(data: bytes, most_bytes: int) -> bytes:
    return data


def _content(upload: Any, most_bytes: int) -> bytes:
    upload.seek(0)
    content: bytes = upload.read()
    return content
